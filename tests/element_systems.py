"""Systems that nobody has assembled: the library's main bearing, and blocks tied by a mortar."""

import numpy as np
from coarse_scenes import coarse_scene

from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.elasticity.interfaces.constraints import eliminate, fixed, held_nodes
from fe_drivetrain.elasticity.interfaces.mortar import mortar_tie
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.solve.element_system import ElementSystem
from fe_drivetrain.shafts.response.model import build_model, mesh_scene

RUBBER = (4.95e9, 5e7)  # nu = 0.495


def of_scene(*arguments, **changes):
    scene = coarse_scene(*arguments, **changes)
    model = build_model(scene, mesh_scene(scene))
    return model, ElementSystem(
        model.mesh.points,
        [
            (model.mesh.cells[model.mesh.part_cells(p)], scene.material_of(p).lame)
            for p in model.mesh.part_names
        ],
        eliminate(model.constraints, model.n_dofs),
        model.springs,
    )


def tied_blocks(lower):
    """Two blocks of two materials and meshes, tied by a mortar; the lower one held below."""
    one = brick((3, 3, 2), 10, lambda x: x * [1.0, 1.0, 0.7])
    other = brick((2, 2, 2), 10, lambda x: x * [1.0, 1.0, 0.8] - [0.0, 0.0, 0.8])
    points = np.vstack([one.points, other.points])
    shift = len(one.points)
    n = points.size
    tie = mortar_tie("tie", points, one.faces["z0"], other.faces["z1"] + shift, n)
    bottom = fixed("bottom", np.unique(other.faces["z0"]) + shift, n)
    side = held_nodes("side", np.unique(one.faces["z1"])[:3], (0,), n)
    materials = MATERIALS["steel"].lame, lower
    cells = [(one.cells, materials[0]), (other.cells + shift, materials[1])]
    return ElementSystem(points, cells, eliminate([tie, bottom, side], n))


SPRINGS = {
    "bearing_units.0.interface": "spring",
    "bearing_units.0.stiffness": ["rigid", 1e10, 1e10, 0, 1e8, 1e8],
}

SYSTEMS = {
    "bonded": lambda: of_scene("bonded")[1],
    "sliding": lambda: of_scene("spherical")[1],
    "averaged": lambda: of_scene("spherical", **{"bearing_units.0.interface": "averaged"})[1],
    "rigid": lambda: of_scene("spherical", **{"bearing_units.0.interface": "rigid"})[1],
    "springs": lambda: of_scene("spherical", **SPRINGS)[1],
    "mortar": lambda: tied_blocks((5e10, 2.6e10)),
    "rubber": lambda: tied_blocks(RUBBER),
}
