"""From operator and constraints to displacements: reduction, solvers, condensation, errors.

In: a sparse stiffness, constraints, load columns. Out: solutions with their diagnostics.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
