"""fe-drivetrain: finite-element validation suite for wind-turbine drivetrains.

The rooms show the way the data goes: `geometry` and `drivetrain_file` describe, `elasticity` solves
solids, `shafts` has the main shaft from beam to solid, `bearing`, `bearing_life`, `gear` and
`dynamics` the rest of the drivetrain; `turbine_loads` has what acts on it; `studies` answer;
`report`, `pages`, `export` and `command_line` are the way out. Here is what a first script needs.
"""

# Imported when first used: the command line must not wait for gmsh and scipy to say --help.
import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
