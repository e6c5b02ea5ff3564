"""How parts are joined and supported: linear constraints, bearing joints, ties, mechanisms.

In: faces of a mesh, the kind of joint. Out: constraints ``u = T q + g``, and springs.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
