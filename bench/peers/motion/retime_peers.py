"""Times the same joint paths with toppra and copp and prints the rows that `tracelight-bench-motion retime` prints.

The rig's torque and Coulomb friction; neither takes viscous friction along. copp is timed with accelerations instead of
torque too: there its solver alone is at work, while torque goes through a Python function for every place.
"""

import logging
import sys
import time
import warnings
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
from cases import PATHS, joint_path  # noqa: E402

INERTIA = np.array([0.075, 0.075])
TORQUE = np.array([0.08, 0.1]) * 10 * 0.0432 * 6.3 * 2.8435
COULOMB = np.array([0.05, 0.05])
SPEED = 24.0
warnings.filterwarnings("ignore")


def best_of(times, run):
    took = []
    for _ in range(times):
        start = time.perf_counter()
        result = run()
        took.append(time.perf_counter() - start)
    return result, 1e3 * min(took)


def row(name, way, cells, duration, took_ms):
    print(f"path_{name:11} {cells:7} {duration:12.6f} {took_ms:9.4f}  {way}", flush=True)


def with_toppra(cells):
    import toppra as ta
    import toppra.algorithm as algorithm
    import toppra.constraint as constraint

    ta.setup_logging("ERROR")
    logging.getLogger("toppra").setLevel(logging.ERROR)

    class Spline(ta.interpolator.AbstractGeometricPath):
        dof = property(lambda self: 2)
        path_interval = property(lambda self: np.array([0.0, 1.0]))

        def __init__(self, spline):
            self.derivatives = [spline.derivative(k) if k else spline for k in range(3)]

        def __call__(self, s, order=0):
            return self.derivatives[order](s)

    for name in PATHS:
        path = Spline(joint_path(name))
        grid = np.linspace(0, 1, cells + 1)
        limits = [
            constraint.JointVelocityConstraint(np.array([[-SPEED, SPEED]] * 2)),
            constraint.JointTorqueConstraint(lambda q, v, a: INERTIA * a, np.c_[-TORQUE, TORQUE], COULOMB,
                                             discretization_scheme=constraint.DiscretizationType.Interpolation),
        ]

        def run():
            solver = algorithm.TOPPRA(limits, path, gridpoints=grid, solver_wrapper="seidel")
            return solver.compute_parameterization(0, 0)[1]

        speeds, took = best_of(3, run)
        row(name, "toppra", cells, 2 * np.sum(np.diff(grid) / (speeds[1:] + speeds[:-1])), took)


def with_copp(cells):
    import copp_py as copp

    for name in PATHS:
        spline = joint_path(name)
        s = np.linspace(0, 1, cells + 1)
        q = [np.ascontiguousarray(spline.derivative(k)(s) if k else spline(s)) for k in range(4)]
        for way in ("accelerations", "torque"):

            def run():
                robot = copp.Robot(2, capacity=cells + 1)
                robot.append_s(s)
                robot.set_q(q[0], q[1], q[2], 0, dddq=q[3])
                robot.add_velocity_limits([SPEED] * 2, [-SPEED] * 2, start_idx_s=0)
                if way == "accelerations":
                    most = (TORQUE - COULOMB) / INERTIA
                    robot.add_acceleration_limits(list(most), list(-most), start_idx_s=0)
                else:
                    robot.set_inverse_dynamics(
                        lambda q, v, a: INERTIA * a + COULOMB * np.where(np.abs(v) < 1e-14, 0, np.sign(v)))
                    robot.add_torque_limits(list(TORQUE), list(-TORQUE), start_idx_s=0)
                problem = copp.solver.topp2_ra.Problem(robot.constraints, (0, cells), (0.0, 0.0))
                return copp.interpolation.s_to_t_topp2(s, copp.solver.topp2_ra.solve(problem), 0.0)

            times, took = best_of(5, run)
            duration = times[0] if isinstance(times, tuple) else times
            row(name, f"copp, {way}", cells, float(np.ravel(duration)[-1]), took)


def main():

    for cells in map(int, sys.argv[1:] or ["1000"]):
        for peer in (with_toppra, with_copp):
            try:
                peer(cells)
            except ImportError as missing:
                print(f"!!! {missing}: left out")


if __name__ == "__main__":
    main()
