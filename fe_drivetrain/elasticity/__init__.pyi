from . import interfaces as interfaces
from . import mesh as mesh
from . import operator as operator
from . import revolution as revolution
from . import solve as solve
