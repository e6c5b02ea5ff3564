from .advise import QUICK_BAND as QUICK_BAND
from .advise import show_advise as show_advise
from .uncertainty import bands as bands
from .uncertainty import show_uncertainty as show_uncertainty
from .whirl import show_whirl as show_whirl
from .written import write_page as write_page
