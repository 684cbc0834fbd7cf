"""One self-contained HTML page about a fit, what was learnt and what was not, about a comparison or a calibration."""

from skinbayes.report.calibration_page import write_calibration
from skinbayes.report.comparison_page import write_comparison
from skinbayes.report.digest import digest
from skinbayes.report.joint_page import joint_digest, joint_remarks
from skinbayes.report.methods import methods_text
from skinbayes.report.page import write_report
from skinbayes.report.paper_tables import paper_table
from skinbayes.report.remarks import remarks
from skinbayes.report.reproduction_page import write_reproduction

__all__ = [
    "digest",
    "joint_digest",
    "joint_remarks",
    "methods_text",
    "paper_table",
    "remarks",
    "write_calibration",
    "write_comparison",
    "write_report",
    "write_reproduction",
]
