"""Bodies of revolution in Fourier harmonics: the exact elasticity of a shaft from its meridian.

In: a shaft's profile. Out: stiffness between ends and seats, stresses, influence functions.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
