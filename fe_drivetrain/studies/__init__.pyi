from .design_comparison import CompareResult as CompareResult
from .design_comparison import Varied as Varied
from .design_comparison import compare as compare
from .result import Result as Result
from .scene_check import CheckResult as CheckResult
from .scene_check import check as check
