from .fillet_stress import LOADS as LOADS
from .fillet_stress import PER_FILLET as PER_FILLET
from .fillet_stress import Peak as Peak
from .fillet_stress import Shoulder as Shoulder
from .fillet_stress import end_stress as end_stress
from .fillet_stress import fillet_factor as fillet_factor
from .fillet_stress import fillet_peak as fillet_peak
from .fillet_stress import shouldered as shouldered
