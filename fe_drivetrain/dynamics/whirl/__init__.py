"""Whirl of shafts on bearings: modes over speed, critical speeds, unbalance, stability."""
