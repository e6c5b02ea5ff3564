"""How the comparison with other tools is measured, in words for its page."""

from fe_drivetrain.cases.performance.peers import Plan


def of_motions(number: int) -> list[str]:
    """What several right-hand sides are, and what each tool shares between them."""
    if number == 1:
        return []
    return [
        f"The moved face has {number} motions: the one that is named first, and translations, "
        "twist, stretches, shear and tilts of the face, of which nine are linearly independent; a "
        "tenth is their mean, of which no tool makes use. Tools that take it keep "
        "matrix and factor or preconditioner for all of them; CalculiX and SfePy, which have "
        "prescribed displacements in the equations that they set up, solve one after the other "
        "from the beginning. Errors are the largest of all motions."
    ]


def method(plan: Plan) -> list[str]:
    """How it was measured."""
    limits = plan.limits
    return [
        "All tools get the same curved ten-node tetrahedra, materials and prescribed "
        "displacements: one face held, all nodes of another moved as a rigid body. The answer is "
        "the stiffness uᵀKu, twice the strain energy, at unit motion.",
        "The clock runs from the mesh in memory, in each tool's own form, to the stiffness: "
        "assembly, boundary conditions, solver, energy. Imports and taking the mesh in, shown "
        "beside it, are left out for all. CalculiX reads a deck instead; its clock starts "
        "when it says that its step begins, so reading is left out for it too.",
        "Each run is a fresh process, which first solves a small problem. Tools take turns, so "
        f"that what else the machine does hits all equally; runs of each: {plan.repetitions}, "
        "however long they take. Tables of a mesh have the least, the median and the most of them; "
        f"elsewhere the median stands. A run over {limits.seconds:g} s or "
        f"{limits.bytes / 2**30:g} GiB is ended and the row left, and larger meshes are not "
        "begun where a power law through the last two, at least linear, says that they would be.",
        f"Every tool is given {limits.threads} threads, dolfinx as many MPI processes of one "
        "thread each.",
        "With its displacements prescribed a solid's energy is least at the solution, so a "
        "solver's error adds to the stiffness. The reference of each mesh is the median of the "
        "direct solvers, or the least of all where none came to an end.",
        "Quadrature is part of the equations, so tools share a rule where they take one: eleven "
        "points of degree 4, scikit-fem's. CalculiX has four points and no choice; NGSolve and "
        "FElupe would take four by themselves, and are shown with both; Kratos, fedoo and "
        "torch-fem have four. The two rules differ by "
        "more than 1e-6 on coarse meshes, which is why errors are against the reference of the "
        "same rule.",
        "Iterative solvers stop at the loosest power of ten that leaves less than 1e-6 of the "
        "stiffness on every mesh here. That of CalculiX cannot be set in its deck: its own stop "
        "leaves what the tables show. With Newton's corrections is a way round: a step of large "
        "displacements at 1e-8 of the motion, whose every correction goes through the iterative "
        "solver again until the forces are balanced to 1e-7.",
        "On thin walls and slender shafts the question is that of spectral coarse spaces: "
        "`--set problems=[tube,slender] tools=[this_project.auto,this_project.schwarz,dolfinx] "
        "sizes=[100000,1000000]` sets this project's Schwarz method beside PETSc's, of which each "
        "process has a part. Schwarz here is GenEO by itself (Spillane et al. 2014): the coarse "
        "space comes from an eigenvalue problem of each patch. Of PETSc there are adaptive PCBDDC, "
        "whose coarse space comes from eigenvalue problems of the borders between parts, and GAMG. "
        "PCHPDDM, which is GenEO too, needs a PETSc that was configured with HPDDM and SLEPc: "
        "Debian's is not, and PyPI has none that is built; where a PETSc has it, its row is "
        "there.",
        "The wheels of MFEM and Kratos are taken as they are: MFEM's is serial, without hypre or "
        "SuiteSparse, so that its own solver is Gauss-Seidel and PARDISO is plugged in; Kratos's "
        "has neither PARDISO nor CHOLMOD, and counts assembly as solver, which it has in one call.",
        "SfePy has tetrahedra with straight edges only. It is given the curved nodes for its "
        "field and its mapping; the assembly stays its own.",
    ]
