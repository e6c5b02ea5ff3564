from .advice_page import advised as advised
from .app import main as main
from .app import main_of_case as main_of_case
from .app import parse_settings as parse_settings
from .uncertainty_page import bands as bands
from .uncertainty_page import first_order as first_order
from .uncertainty_page import relative_spread as relative_spread
from .uncertainty_page import uncertain as uncertain
