"""What data can and cannot tell about parameters, in words. Works for any problem; knows nothing of skin."""

from skinbayes.diagnose.findings import Identifiability
from skinbayes.diagnose.identifiability import identify
from skinbayes.diagnose.prior_checks import PriorUpdate, Ridge, prior_updates, ridges

__all__ = ["Identifiability", "PriorUpdate", "Ridge", "identify", "prior_updates", "ridges"]
