"""Drivetrains as bodies on springs: machines, gears, planets, flexible shafts, modes, responses."""
