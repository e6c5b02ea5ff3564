"""The six steps by which a team validates a drivetrain, pitch or yaw model (PROTEST 2010).

In: project files, results of cases, torsional systems, load histories, channels of a campaign,
tables of loads at interfaces. Out: how each step stands and what it lacks, virtual measurements,
identified parameters with bands, drive torques, duty, and what the report's own equations make of
the same data.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
