"""One self-contained HTML page about a fit: what was learnt and what was not."""

from skinbayes.report.page import write_report

__all__ = ["write_report"]
