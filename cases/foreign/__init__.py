"""Parts from files of other programs: STEP solids and meshes in place of parametric housings."""
