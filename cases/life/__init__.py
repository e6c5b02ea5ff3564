"""Rating life of rolling bearings: acceptance, studies of a main bearing."""
