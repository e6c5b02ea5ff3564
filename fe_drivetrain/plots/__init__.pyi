from .figures import error_against_time as error_against_time
from .figures import figure as figure
from .figures import load_bars as load_bars
from .figures import load_lines as load_lines
from .figures import stiffness_map as stiffness_map
from .style import PALETTE as PALETTE
from .style import styled as styled
