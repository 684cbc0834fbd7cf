"""One self-contained HTML page about a fit: what was learnt and what was not."""

from skinbayes.report.digest import digest
from skinbayes.report.page import write_report

__all__ = ["digest", "write_report"]
