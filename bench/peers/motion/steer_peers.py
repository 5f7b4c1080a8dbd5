#!/usr/bin/env python3
"""Fastest moves by ruckig's own Python package, on the cases of `cases.py`: `steer_peers.py moves.csv`."""

import sys
import time

import numpy as np
from ruckig import InputParameter, Result, Ruckig, Trajectory

VELOCITY, ACCELERATION, JERK, TIMES = 24.0, 100.0, 2000.0, 5

table = np.loadtxt(sys.argv[1], delimiter=",", skiprows=1)
solver, trajectory = Ruckig(2), Trajectory(2)
took, durations, failures = [], [], 0
for row in table:
    case = InputParameter(2)
    case.current_position, case.current_velocity, case.current_acceleration = row[0:2], row[2:4], row[4:6]
    case.target_position, case.target_velocity, case.target_acceleration = row[6:8], row[8:10], row[10:12]
    case.max_velocity, case.max_acceleration, case.max_jerk = [VELOCITY] * 2, [ACCELERATION] * 2, [JERK] * 2
    best = np.inf
    for _ in range(TIMES):
        start = time.perf_counter()
        result = solver.calculate(case, trajectory)
        best = min(best, time.perf_counter() - start)
    took.append(1e6 * best)
    if result in (Result.Working, Result.Finished):
        durations.append(trajectory.duration)
    else:
        failures += 1
median, p99 = np.percentile(took, [50, 99])
print(f"{'ruckig (C++)':12} {len(table):8} {failures:9} {sum(durations):16.9f} {median:9.2f} {p99:9.2f}")
