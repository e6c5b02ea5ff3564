"""Strength of a shaft: nominal and local stress, notches, cycles and damage, joints.

In: steel, sections, internal forces or load histories. Out: safety, damage, stress with bands.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
