"""Hours and time factors of Al-Hamadani 2018, Tables 7.1 and 7.2, as printed."""

SOURCE = "Al-Hamadani 2018"
WINDS = tuple(range(4, 26))
"""Table 7.1: upper ends of the bins of wind speed [m/s]."""
HOURS: tuple[int, ...] = (
    8733,
    10545,
    11916,
    12817,
    13251,
    13247,
    12856,
    12146,
    11194,
    10080,
    8878,
    7655,
    6467,
)
HOURS += (5356, 4351, 3468, 2713, 2084, 1573, 1165, 848, 607)
"""Table 7.1: in 20 years."""
FACTORS: tuple[int, ...] = (
    1571855,
    1898039,
    2144818,
    2307084,
    2385178,
    2384376,
    2313997,
    2186246,
    2014953,
)
FACTORS += (1814352, 1598001, 1377938, 1164124, 964148, 783209, 624278, 488421, 375193, 283052)
FACTORS += (209761, 152726, 109270)
"""Table 7.1: how often a history of 20 s is in them."""
DIVISORS = {
    "stage 1 planet, flank to sun": 58,
    "stage 1 ring": 145,
    "stage 1 sun": 116,
    "stage 2 gear": 116,
    "stage 2 pinion": 464,
    "stage 3 gear": 464,
    "stage 3 pinion": 1776,
}
"""What the columns of Table 7.2 divide the time factors by: drivetrain C, the last rounded from
58 6 4 111/29 / 3."""
ADJUSTED_WINDS = tuple(range(12, 25, 2))
"""Table 7.2: wind speeds [m/s]."""
ADJUSTED = (
    (34741, 13896, 17370, 17370, 4343, 4343, 1135),
    (27552, 11021, 13776, 13776, 3444, 3444, 900),
    (20071, 8028, 10036, 10036, 2509, 2509, 655),
    (13504, 5401, 6752, 6752, 1688, 1688, 441),
    (8421, 3368, 4211, 4211, 1053, 1053, 275),
    (4880, 1952, 2440, 2440, 610, 610, 159),
    (2633, 1053, 1317, 1317, 329, 329, 86),
)
"""Table 7.2, columns as `DIVISORS`."""
