"""OpenFAST's SubDyn: a spring element of 21 terms between two joints in one place.

A stiffness of one point to the ground, such as a bearing in its housing: joint 1 is the ground
(held by the transition piece), joint 2 the point. What is written is a whole SubDyn input of
OpenFAST 5 (r-test, SD_Spring_Case1); its spring, cosine matrix and member go into any other.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import require_readable
from fe_drivetrain.common.scaling import max_difference
from fe_drivetrain.export.formats.openfast_inputs import openfast_reader
from fe_drivetrain.export.formats.statement import comment_lines, statement
from fe_drivetrain.export.superelement import ALLOWED, Superelement

#: Names of the upper triangle, by rows.
TERMS = tuple(f"k{i}{j}" for i in range(1, 7) for j in range(i, 7))
_COSINES = tuple(f"COSM{i}{j}" for i in range(1, 4) for j in range(1, 4))
_INERTIAS = ("JMXX", "JMYY", "JMZZ", "JMXY", "JMXZ", "JMYZ")


_INPUT = """\
----------- SubDyn input file: one spring element --------------------------------------
{name}, scene {scene}; N, m, kg, rad; {stated}; more at the end
-------------------------- SIMULATION CONTROL ------------------------------------------
False       Echo
"DEFAULT"   SDdeltaT
3           IntMethod
True        SttcSolve
-------------------- FEA and CRAIG-BAMPTON PARAMETERS ----------------------------------
3           FEMMod
1           NDiv
{modes}           Nmodes       - all of the second joint, where it has mass
0           JDampings    - (%)
0           GuyanDampMod
0.0 0.0     RayleighDamp
6           GuyanDampSize
{zeros}
------- INITIAL RIGID-BODY POSITION ----------------------------------------------------
RBSurge RBSway RBHeave RBRoll RBPitch RBYaw
(m) (m) (m) (deg) (deg) (deg)
0.0 0.0 0.0 0.0 0.0 0.0
---- STRUCTURE JOINTS ------------------------------------------------------------------
2           NJoints      - the ground and {point}, in one place
JointID JointXss JointYss JointZss JointType JointDirX JointDirY JointDirZ JointStiff
(-) (m) (m) (m) (-) (-) (-) (-) (Nm/rad)
1 {place} 1 0.0 0.0 0.0 0.0
2 {place} 1 0.0 0.0 0.0 0.0
------------------- BASE REACTION JOINTS -----------------------------------------------
0           NReact
RJointID RctTDXss RctTDYss RctTDZss RctRDXss RctRDYss RctRDZss SSIfile
(-) (flag) (flag) (flag) (flag) (flag) (flag) (string)
------- INTERFACE JOINTS ---------------------------------------------------------------
1           NInterf
IJointID TPID ItfTDXss ItfTDYss ItfTDZss ItfRDXss ItfRDYss ItfRDZss
(-) (-) (flag) (flag) (flag) (flag) (flag) (flag)
1 1 {held}
----------------------------------- MEMBERS --------------------------------------------
1           NMembers
MemberID MJointID1 MJointID2 MPropSetID1 MPropSetID2 MType MSpin/COSMID
(-) (-) (-) (-) (-) (-) (deg/-)
1 1 2 1 1 5 1
------------------ CIRCULAR BEAM CROSS-SECTION PROPERTIES ------------------------------
1           NPropSetsCyl - no member has it
PropSetID YoungE ShearG MatDens XsecD XsecT
(-) (N/m2) (N/m2) (kg/m3) (m) (m)
1 2.1e11 8.0e10 7850.0 1.0 0.025
----------------- RECTANGULAR BEAM CROSS-SECTION PROPERTIES ----------------------------
0           NPropSetsRec
PropSetID YoungE ShearG MatDens XsecSa XsecSb XsecT
(-) (N/m2) (N/m2) (kg/m3) (m) (m) (m)
----------------- ARBITRARY BEAM CROSS-SECTION PROPERTIES ------------------------------
0           NXPropSets
PropSetID YoungE ShearG MatDens XsecA XsecAsx XsecAsy XsecJxx XsecJyy XsecJ0 XsecJt
(-) (N/m2) (N/m2) (kg/m3) (m2) (m2) (m2) (m4) (m4) (m4) (m4)
-------------------------- CABLE PROPERTIES --------------------------------------------
0           NCablePropSets
PropSetID EA MatDens T0 CtrlChannel
(-) (N) (kg/m) (N) (-)
----------------------- RIGID LINK PROPERTIES ------------------------------------------
0           NRigidPropSets
PropSetID MatDens
(-) (kg/m)
----------------------- SPRING ELEMENT PROPERTIES --------------------------------------
1           NSpringPropSets
PropSetID {names}
(-) {units}
1 {terms}
---------------------- MEMBER COSINE MATRICES COSM(i,j) --------------------------------
1           NCOSMs       - rows: the element's x, y, z in SubDyn's frame
COSMID {cosine_names}
(-) {cosine_units}
1 {cosines}
------------------------ JOINT ADDITIONAL CONCENTRATED MASSES --------------------------
{masses}           NCmass
CMJointID JMass {inertia_names} MCGX MCGY MCGZ
(-) (kg) {inertia_units} (m) (m) (m)
{added}---------------------------- OUTPUT: SUMMARY & OUTFILE ---------------------------------
False       SumPrint
0           OutCBModes
0           OutFEMModes
False       OutCOSM
False       OutAll
1           OutSwtch
True        TabDelim
1           OutDec
"ES11.4e2"  OutFmt
"A11"       OutSFmt
------------------------- MEMBER OUTPUT LIST -------------------------------------------
1           NMOutputs
MemberID NOutCnt NodeCnt
(-) (-) (-)
1 2 1 2
------------------------- SSOutList ----------------------------------------------------
"M1N2TDzss"  - displacement of the second joint along z
END of output channels
"""


class Spring(NamedTuple):
    """A spring element as it stands in a file.

    Attributes
    ----------
    stiffness : Floats
        (6, 6) in the element's axes.
    axes : Floats
        (3, 3) whose rows are the element's x, y, z in SubDyn's frame.
    joints : Floats
        (2, 3) of its ends [m].
    mass : float
        [kg] at the second joint.
    inertia : Floats
        (3, 3) there, in SubDyn's frame [kg m^2].
    """

    stiffness: Floats
    axes: Floats
    joints: Floats
    mass: float
    inertia: Floats

    @property
    def global_stiffness(self) -> Floats:
        """(6, 6) in SubDyn's frame."""
        turn = np.kron(np.eye(2), self.axes)
        return np.asarray(turn.T @ self.stiffness @ turn)


def write(path: Path, element: Superelement, axes: Floats | None = None) -> None:
    """Write a superelement of one point on the ground; numbers keep every digit.

    Parameters
    ----------
    path : Path
        The file.
    element : Superelement
        Superelement of one point, with its supports. A mass must be that of a rigid body with its
        centre at the point.
    axes : Floats or None
        (3, 3) whose rows are x, y, z of the superelement's frame in SubDyn's; the same frame where
        not given. Both have their origin in one place.

    Raises
    ------
    InputError
        The superelement has more points, no supports, or another mass; or the axes are not a
        right-handed orthonormal frame.
    """
    A = _checked_axes(element, axes)
    mass, inertia = _rigid_mass(element)
    inertia = A.T @ inertia @ A
    inertias = [
        inertia["xyz".index(name[2].lower()), "xyz".index(name[3].lower())] for name in _INERTIAS
    ]
    band = "not known" if element.band is None else element.band.in_percent
    stated = element.of_units | {"band": band}
    text = _INPUT.format(
        name=element.name,
        scene=element.origin.scene_hash or "unknown",
        stated="; ".join(f"{key}: {text}" for key, text in stated.items()),
        modes=6 if mass else 0,
        zeros="\n".join([" ".join(["0.0"] * 6)] * 6),
        point=element.points[0],
        place=_numbers(A.T @ element.positions[0]),
        held=" ".join(["1"] * 6),
        names=" ".join(TERMS),
        units=" ".join(_unit(term) for term in TERMS),
        terms=_numbers(element.stiffness[np.triu_indices(6)]),
        cosine_names=" ".join(_COSINES),
        cosine_units=" ".join(["(-)"] * 9),
        cosines=_numbers(A.ravel()),
        masses=1 if mass else 0,
        inertia_names=" ".join(_INERTIAS),
        inertia_units=" ".join(["(kg*m^2)"] * 6),
        added=f"2 {mass!r} {_numbers(inertias)} 0.0 0.0 0.0\n" if mass else "",
    )
    comments = "\n".join(comment_lines(statement(element), "!"))
    path.write_text(f"{text}{comments}\n", encoding="utf-8")


def _checked_axes(element: Superelement, axes: Floats | None) -> Floats:
    """Axes of a frame, of a superelement that a spring can hold."""
    if len(element.points) != 1 or not element.supported:
        raise InputError(
            f"superelement {element.name!r} has {len(element.points)} points and supports "
            f"{'in it' if element.supported else 'left out'}: a SubDyn spring takes one point, "
            "with the supports"
        )
    A = np.eye(3) if axes is None else np.asarray(axes, dtype=float)
    # to the digits of a double: a cosine of 5 digits is not orthogonal to more
    if A.shape != (3, 3) or not (
        np.abs(A @ A.T - np.eye(3)).max() < 1e-12 and np.linalg.det(A) > 0
    ):
        raise InputError("the axes must be a (3, 3) right-handed orthonormal frame, to 12 digits")
    return A


def _numbers(values: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in values)


def read_spring(path: str | Path) -> Spring:
    """The first spring element of a SubDyn input, as openfast_io reads it.

    Raises
    ------
    MissingToolError
        openfast_io is not installed.
    InputError
        openfast_io cannot read the file, or it has no spring element between its joints.
    """
    require_readable(path, "SubDyn input")
    reader = openfast_reader()
    reader.fst_vt["outlist"]["SubDyn"] = {}
    try:
        reader.read_SubDyn(str(path))
        values = reader.fst_vt["SubDyn"]
        member = values["MType"].index(5)
        row = values["SpringPropSetID"].index(values["MPropSetID1"][member])
        turn = values["COSMID"].index(values["M_COSMID"][member])
        ends = [values["JointID"].index(values[f"MJointID{k}"][member]) for k in (1, 2)]
        upper = np.zeros((6, 6))
        # openfast_io leaves the 21 terms as text
        upper[np.triu_indices(6)] = [float(values[term][row]) for term in TERMS]
        axes = np.array([values[name][turn] for name in _COSINES]).reshape(3, 3)
        joints = np.array([[values[f"Joint{c}ss"][end] for c in "XYZ"] for end in ends])
        mass, inertia = 0.0, np.zeros((3, 3))
        if values["MJointID2"][member] in values["CMJointID"]:
            lump = values["CMJointID"].index(values["MJointID2"][member])
            mass = float(values["JMass"][lump])
            xx, yy, zz, xy, xz, yz = (values[name][lump] for name in _INERTIAS)
            inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    # whatever a line that cannot be read makes openfast_io raise
    except Exception as error:
        raise InputError(
            f"openfast_io finds no spring element in {path} as SubDyn input: "
            f"{type(error).__name__} {error}"
        ) from error
    return Spring(upper + np.triu(upper, 1).T, axes, joints, mass, inertia)


def _rigid_mass(element: Superelement) -> tuple[float, Floats]:
    """Mass and inertia of a rigid body with its centre at the point."""
    M = element.mass
    if M is None:
        return 0.0, np.zeros((3, 3))
    mass = float(np.trace(M[:3, :3]) / 3)
    rigid = np.zeros((6, 6))
    rigid[:3, :3] = mass * np.eye(3)
    rigid[3:, 3:] = M[3:, 3:]
    if max_difference(rigid, M) > ALLOWED:
        raise InputError(
            f"superelement {element.name!r} has a mass that is no rigid body's with its centre at "
            f"{element.points[0]}, and SubDyn's joints take no other: leave the mass out"
        )
    return mass, M[3:, 3:]


def _unit(term: str) -> str:
    turns = sum(int(digit) > 3 for digit in term[1:])
    return ("(N/m)", "(N/rad)", "(Nm/rad)")[turns]
