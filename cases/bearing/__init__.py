"""Rolling bearings by themselves: rollers and laminae between rigid rings."""
