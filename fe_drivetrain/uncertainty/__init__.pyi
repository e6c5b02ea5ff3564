from .input_study import Study as Study
from .input_study import study as study
from .sampling import nominal_value as nominal_value
from .sampling import sample as sample
from .sampling import sensitivities as sensitivities
from .sampling import sobol_shares as sobol_shares
from .sampling import with_values as with_values
