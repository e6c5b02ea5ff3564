"""fe-drivetrain: finite-element validation suite for wind-turbine drivetrains.

The rooms show the way the data goes: `geometry`, `scene`, `mesh`, `operator`, `interfaces`,
`solve`, `response`, beside them the cheaper models `beam`, `revolution` and `torsion`; `fidelity`
and `uncertainty` put them side by side; `hub_loads` and `compare` take load histories; `export`,
`report`, `suite` and `commands` are the way out. Here stands what a first script needs.
"""

# Imported when first used: the command line must not wait for gmsh and scipy to say --help.
import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
