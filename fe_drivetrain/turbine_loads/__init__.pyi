from . import histories as histories
from . import hub_loads as hub_loads
