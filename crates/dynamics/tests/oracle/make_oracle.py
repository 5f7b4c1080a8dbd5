"""Makes set_a.csv and set_b.csv: the head's mass matrix and bias torques by Pinocchio, a rigid-body library that
shares nothing with this crate. `cargo test -p tracelight-dynamics` compares its own equations with them.

    python3 -m venv /tmp/oracle && /tmp/oracle/bin/pip install pin
    /tmp/oracle/bin/python crates/dynamics/tests/oracle/make_oracle.py

The script checks Pinocchio against a closed form derived here by hand (and against MuJoCo where that is installed)
and refuses to write when they differ by more than 1e-12.

Model: pan about +z, tilt about the pan-carried +y, both axes through the origin; at zero the beam is +x; gravity
along -z. Inertias are tensor entries about the centre of mass: an off-diagonal entry I12 stands in the matrix as it
is printed (it is minus the integral of xy dm, not plus).

What of the tables shows in the numbers: of the pan body only mass, centre x and y, and I33, and those only in m11;
its centre's z (so l1) and its other five inertias turn about z without effect. Of the tilt body everything does; its
products show in m12 (I12, I23) and m11 (I13). Rotor inertias add to m11 and m22, which stay free of pan.
"""

import importlib.util
import math
import os
import random

import numpy as np
import pinocchio as pin

HERE = os.path.dirname(os.path.abspath(__file__))
ROWS = 200
SEED = 2006
GRAVITY = 9.807
ROTOR = 2.3e-4
RATIO = 6.3 * 2.8435
L1 = -0.1048  # the pan body's centre is measured from there, along z, in set A
TILT_CENTRE = (0.0750, 0.0151, 0.0046)
LARGEST_DIFFERENCE = 1e-12


def tensor(i11, i12, i13, i22, i23, i33):
    """The symmetric 3x3 matrix with these entries, kg m^2."""
    return np.array([[i11, i12, i13], [i12, i22, i23], [i13, i23, i33]])


SETS = {
    "set_a": {
        "pan": (0.5507, (-0.0122, 0.0066, 0.0549 - L1),
                tensor(1.162e-3, -5.938e-5, -7.951e-5, 7.658e-4, -1.269e-4, 7.469e-4)),
        "tilt": (0.2035, TILT_CENTRE, tensor(3e-4, 0.0, 0.0, 6.957e-5, -6.931e-6, 3.041e-4)),
        "rotor": ROTOR * RATIO * RATIO,
    },
    "set_b": {
        "pan": (0.5603, (-0.0126, -0.0228, -0.0003), tensor(1.2e-3, 0.0, -1e-4, 7e-4, -1e-4, 8e-4)),
        "tilt": (0.3611, TILT_CENTRE, tensor(3e-4, -1e-4, 0.0, 6e-4, 0.0, 7e-4)),
        "rotor": ROTOR,  # "as seen by encoder": stands as left, without the ratio
    },
}


def pinocchio_head(head):
    """(q, rates) -> (mass matrix, bias) by Pinocchio's CRBA and RNEA."""
    model = pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, -GRAVITY])
    joint = 0
    for name, kind in (("pan", pin.JointModelRZ()), ("tilt", pin.JointModelRY())):
        joint = model.addJoint(joint, kind, pin.SE3.Identity(), name)
        mass, centre, inertia = head[name]
        model.appendBodyToJoint(joint, pin.Inertia(mass, np.array(centre), inertia), pin.SE3.Identity())
    model.armature = np.array([head["rotor"]] * 2)
    data = model.createData()

    def evaluate(q, rates):
        upper = np.triu(pin.crba(model, data, q))
        return upper + np.triu(upper, 1).T, pin.nonLinearEffects(model, data, q, rates).copy()

    return evaluate


def closed_form_head(head):
    """The same by hand. With c, s of tilt the tilt body's centre is (x, b2, z) = (c b1 + s b3, b2, c b3 - s b1) in
    the pan frame and pan's axis is (-s, 0, c) in the tilt frame; the kinetic energy gives M, Lagrange's equations
    C1 = M11' w1 w2 + M12' w2^2 and C2 = -M11' w1^2 / 2, the height z gives gravity."""
    mass_a, (a1, a2, _), ia = head["pan"]
    mass_b, (b1, b2, b3), ib = head["tilt"]

    def evaluate(q, rates):
        s, c = math.sin(q[1]), math.cos(q[1])
        x, z = c * b1 + s * b3, c * b3 - s * b1
        axis, axis_slope = np.array([-s, 0.0, c]), np.array([-c, 0.0, -s])
        m11 = head["rotor"] + ia[2, 2] + mass_a * (a1**2 + a2**2) + axis @ ib @ axis + mass_b * (x**2 + b2**2)
        m12 = axis @ ib[:, 1] - mass_b * b2 * z
        m22 = head["rotor"] + ib[1, 1] + mass_b * (b1**2 + b3**2)
        m11_slope = 2.0 * (axis_slope @ ib @ axis + mass_b * x * z)
        m12_slope = axis_slope @ ib[:, 1] + mass_b * b2 * x
        w1, w2 = rates
        bias = (m11_slope * w1 * w2 + m12_slope * w2**2, -0.5 * m11_slope * w1**2 - mass_b * GRAVITY * x)
        return np.array([[m11, m12], [m12, m22]]), np.array(bias)

    return evaluate


def mujoco_head(head):
    """The same by MuJoCo, told to leave masses and inertias as they are given."""
    import mujoco

    def inertial(name):
        mass, centre, i = head[name]
        full = (i[0, 0], i[1, 1], i[2, 2], i[0, 1], i[0, 2], i[1, 2])
        row = lambda values: " ".join(repr(float(v)) for v in values)
        return f'<inertial pos="{row(centre)}" mass="{mass}" fullinertia="{row(full)}"/>'

    rotor = repr(head["rotor"])
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco><compiler angle="radian" balanceinertia="false" boundmass="0" boundinertia="0"/>
      <option gravity="0 0 -{GRAVITY}"/><worldbody>
        <body><joint type="hinge" axis="0 0 1" armature="{rotor}"/>{inertial("pan")}
          <body><joint type="hinge" axis="0 1 0" armature="{rotor}"/>{inertial("tilt")}</body>
        </body></worldbody></mujoco>""")
    data = mujoco.MjData(model)

    def evaluate(q, rates):
        data.qpos[:], data.qvel[:] = q, rates
        mujoco.mj_forward(model, data)
        columns = []
        for unit in np.eye(2):
            column = np.zeros(2)
            mujoco.mj_mulM(model, data, column, unit)
            columns.append(column)
        return np.array(columns).T, data.qfrc_bias.copy()

    return evaluate


def states():
    """Seeded states over the whole range of motion: (q, rates), rad and rad/s."""
    draw = random.Random(SEED)
    for _ in range(ROWS):
        q = np.array([draw.uniform(-3.0, 3.0), draw.uniform(-1.5, 1.5)])
        yield q, np.array([draw.uniform(-5.0, 5.0), draw.uniform(-5.0, 5.0)])


def difference(one, other):
    """Largest difference of mass matrix (kg m^2) and bias (N m) over all states."""
    pairs = [(one(*at), other(*at)) for at in states()]
    return tuple(max(np.abs(a[i] - b[i]).max() for a, b in pairs) for i in (0, 1))


def write(name, evaluate, agreement):
    """One CSV, 17 significant digits: every f64 comes back as it was."""
    with open(os.path.join(HERE, f"{name}.csv"), "w", newline="\n") as file:
        file.write(f"# {name}: {ROWS} states, seed {SEED}, Pinocchio {pin.__version__}, made by make_oracle.py\n")
        file.write(f"# {agreement}\n")
        file.write("# rad, rad/s, kg m^2, N m; M qdd + bias = tau, without friction\n")
        file.write("pan,tilt,pan_rate,tilt_rate,m11,m12,m22,bias1,bias2\n")
        for q, rates in states():
            mass, bias = evaluate(q, rates)
            row = (*q, *rates, mass[0, 0], mass[0, 1], mass[1, 1], *bias)
            file.write(",".join(f"{value:.17g}" for value in row) + "\n")


def main():
    checks = {"closed form": closed_form_head}
    if importlib.util.find_spec("mujoco"):
        checks["MuJoCo"] = mujoco_head
    for name, head in SETS.items():
        oracle = pinocchio_head(head)
        found = {other: difference(oracle, build(head)) for other, build in checks.items()}
        text = "; ".join(f"{other}: |dM| <= {m:.1e}, |dbias| <= {b:.1e}" for other, (m, b) in found.items())
        print(f"{name}: {text}")
        # MuJoCo is shown, not demanded: one oracle and one derivation decide
        if max(found["closed form"]) > LARGEST_DIFFERENCE:
            raise SystemExit(f"{name}: Pinocchio and the closed form differ by more than {LARGEST_DIFFERENCE}")
        m, b = found["closed form"]
        write(name, oracle, f"against a closed form: |dM| <= {m:.1e} kg m^2, |dbias| <= {b:.1e} N m")


if __name__ == "__main__":
    main()
