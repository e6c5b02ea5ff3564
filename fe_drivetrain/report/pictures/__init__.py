"""Pictures of models and of deformed shapes, drawn without a screen.

`view` looks, `surfaces` are what VTK draws of a mesh, `sheet` is what they and the text over them
are drawn on, `bodies` are parts of meshes, `symbols` loads and supports; `model`, `deformation` and
`part` plan the pictures, which `drawing_process` draws beside other work.

In: models, responses, bearings. Out: pictures as files and as HTML.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
