"""A superelement as a housing of a scene: condensed to its bore, its feet on the ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import validated
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.geometry import CondensedHousing


def condensed_housing(
    element: Superelement, bore: str = "", held: Sequence[str] = ()
) -> CondensedHousing:
    """A housing that is a stiffness alone, of a superelement.

    Parameters
    ----------
    element : Superelement
        Its frame is the scene's. Points that are neither the bore nor held are free.
    bore : str
        The point that is the middle of the bore; may be left out where there is but one.
    held : Sequence[str]
        Points that stand on the ground; none where its supports are in it already.

    Returns
    -------
    CondensedHousing
        Its stiffness is that at the bore's point, which is to be the bearing's centre.

    Raises
    ------
    InputError
        There is no such point, a point is both, or what is left moves freely.
    """
    names = list(element.points)
    bore = bore or (names[0] if len(names) == 1 else "")
    for name in (bore, *held):
        if name not in names:
            raise InputError(
                f"superelement {element.name!r}: there is no point {name!r}: name the bore, and "
                f"what is held, among {', '.join(names)}"
            )
    if bore in held:
        raise InputError(f"superelement {element.name!r}: the bore {bore!r} is held: hold another")
    first = names.index(bore)
    free = [k for k, name in enumerate(names) if name != bore and name not in held]
    own = 6 * first + np.arange(6)
    others = np.concatenate([6 * k + np.arange(6) for k in free]) if free else np.zeros(0, int)
    K = element.stiffness
    found = K[np.ix_(own, own)]
    if others.size:
        across = K[np.ix_(others, own)]
        try:
            found = found - across.T @ np.linalg.solve(K[np.ix_(others, others)], across)
        except np.linalg.LinAlgError:
            raise InputError(
                f"superelement {element.name!r}: its free points move without force: hold more"
            ) from None
    found = 0.5 * (found + found.T)
    rows = tuple(tuple(row) for row in found.tolist())
    source = f"superelement {element.name}, point {bore}"
    if held:
        source += f", {', '.join(held)} held"
    return validated(
        CondensedHousing,
        {"stiffness": rows, "source": source},
        f"superelement {element.name!r} as a housing",
    )
