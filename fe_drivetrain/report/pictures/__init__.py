"""Pictures of models and of deformed shapes, drawn without a screen.

`view` looks, `surfaces` are what VTK draws of a mesh, `sheet` is what they and the text over them
are drawn on, `symbols` are loads and supports; `model` and `deformation` draw the pictures.

In: models, responses, bearings. Out: pictures as files and as HTML.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
