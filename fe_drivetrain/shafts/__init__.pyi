from . import beam as beam
from . import fidelity as fidelity
from . import response as response
from . import strength as strength
from . import uncertainty as uncertainty
