from .deformation import picture_of_deformation as picture_of_deformation
from .deformation import picture_of_displacements as picture_of_displacements
from .model import picture_of_model as picture_of_model
from .off_screen import NoPictureError as NoPictureError
from .off_screen import can_draw as can_draw
from .sketch import sketch as sketch
