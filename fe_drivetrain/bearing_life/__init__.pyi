from . import coupled as coupled
from . import life as life
from . import rings as rings
