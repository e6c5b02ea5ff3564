from .app import main as main
from .app import main_of_case as main_of_case
from .progress import show_steps as show_steps
from .run import run_and_print as run_and_print
from .settings import parse_loads as parse_loads
from .settings import parse_settings as parse_settings
from .settings import parse_tolerance as parse_tolerance
