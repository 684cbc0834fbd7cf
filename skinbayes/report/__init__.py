"""One self-contained HTML page about a fit: what was learnt and what was not."""

from skinbayes.report.digest import digest
from skinbayes.report.page import write_report
from skinbayes.report.remarks import remarks

__all__ = ["digest", "remarks", "write_report"]
