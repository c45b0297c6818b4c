#!/usr/bin/env python3
"""Uses the Python module as a user would: check_delassus_python.py FOLDER, where the module is."""
import gc
import math
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

MODULE = Path(sys.argv[1]).resolve()
sys.path.insert(0, str(MODULE))
import delassus  # noqa: E402

G = 9.81
PENDULUM = """<robot name="pendulum">
  <link name="world"/>
  <link name="rod">
    <inertial><origin xyz="1 0 0"/><mass value="2"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="swing" type="continuous"><parent link="world"/><child link="rod"/><axis xyz="0 1 0"/></joint>
</robot>
"""
BOX = """<mujoco><worldbody><body name="box" pos="0 0 3"><freejoint name="root"/><geom type="box" size="0.2 0.2 0.1" mass="1.5"/></body></worldbody>
<keyframe><key name="up" qpos="1 2 3 1 0 0 0" qvel="0.5 0 4 0 0 2"/></keyframe></mujoco>
"""
# A wheel on a vertical axis beside a body on a ball joint, which hangs on one that floats.
PARTS = """<mujoco><option gravity="0 0 0"/><worldbody>
<body name="wheel" pos="3 0 0"><joint name="turn" axis="0 0 1"/><inertial pos="0 0 0" mass="1" diaginertia="0.5 0.5 0.5"/></body>
<body name="hull"><freejoint name="root"/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>
<body name="head"><joint name="neck" type="ball"/><inertial pos="0 0 0" mass="1" diaginertia="0.25 0.25 0.25"/></body></body>
</worldbody><actuator><motor name="engine" joint="turn"/></actuator></mujoco>
"""


# Two rods in a row, the second with a rotor.
DOUBLE = """<mujoco><worldbody><body name="upper"><joint name="shoulder" axis="0 1 0"/><inertial pos="0 0 -0.5" mass="1" diaginertia="0.08 0.08 0.01"/>
<body name="lower" pos="0 0 -1"><joint name="elbow" axis="0 1 0" armature="0.05"/><inertial pos="0 0 -0.5" mass="1" diaginertia="0.08 0.08 0.01"/></body></body></worldbody></mujoco>
"""


# A body that flies with another on a ball joint.
FLYING = """<mujoco><option gravity="0 0 0"/><worldbody><body><freejoint/><inertial pos="0.1 0 0.05" mass="1" diaginertia="0.3 0.2 0.15"/>
<body pos="0.5 0 0"><joint type="ball" pos="-0.2 0 0"/><inertial pos="0.1 0.1 0" mass="0.7" diaginertia="0.05 0.07 0.06"/></body></body></worldbody></mujoco>
"""
LIFTED = """<mujoco><worldbody><body gravcomp="GRAVCOMP"><joint name="b" type="ball" stiffness="STIFFNESS"/><inertial pos="0.3 0 0" mass="1" diaginertia="0.1 0.1 0.1"/></body></worldbody></mujoco>
"""
THREE = """<mujoco><option gravity="0 0 0"/><worldbody><body><joint axis="1 0 0"/><joint axis="0 1 0"/><joint axis="0 0 1"/>
<inertial pos="0.1 0.2 0.3" mass="1" diaginertia="0.2 0.3 0.4"/></body></worldbody></mujoco>
"""


def expect(holds, what):
    if not holds:
        sys.exit(f"check_delassus_python: {what}")


def expect_refused(said, what, *args, **kwargs):
    try:
        what(*args, **kwargs)
    except ValueError as error:
        expect(said in str(error), f"'{error}' does not say '{said}'")
    else:
        sys.exit(f"check_delassus_python: nothing refused what should be: {said}")


def write(folder, name, text):
    path = folder / name
    path.write_text(text)
    return path


def check_pendulum(folder):
    """Energy of a swing, by the implicit midpoint rule: of second order, (h w)^2 / 12 of it with w = 3.1 /s at the most."""
    machine = delassus.Machine(write(folder, "pendulum.urdf", PENDULUM), dt=1e-3, integrator="midpoint", tolerance=1e-12)
    expect(machine.links == ["rod"] and machine.joints == ["swing"] and machine.q_index == {"swing": 0}, f"names: {machine.links} {machine.joints}")
    q, v = machine.q, machine.v
    for _ in range(10):
        steps = machine.step(100)
        expect(steps.count == 100 and steps.unconverged == 0 and steps.joint_gap < 1e-6, f"{steps}")
        energy = 0.5 * (0.01 + 2) * v[0] ** 2 - 2 * G * math.sin(q[0])
        expect(abs(energy) < 1e-5 * 2 * G, f"energy of the swing: {energy}")
    expect(abs(machine.time - 1) < 1e-12 and q[0] > 1.5, f"after 1 s: {machine.time} {q}")
    arm = np.array([math.cos(q[0]), 0, -math.sin(q[0])])
    w = machine.angular_velocities[0]
    expect(np.allclose(machine.positions[0], 0, atol=1e-6) and np.allclose(w, [0, v[0], 0], atol=1e-6), "place and rate of the link")
    turned = machine.orientations[0]
    expect(np.allclose(turned, [math.cos(q[0] / 2), 0, math.sin(q[0] / 2), 0], atol=1e-9) and arm[2] < 0, f"orientation {turned}")


def check_throw(folder):
    """Kick, then drift: z is v t - g t (t + h) / 2 from the start, to rounding; the box turns about an axis of its inertia."""
    machine = delassus.Machine(write(folder, "box.xml", BOX), key="up", dt=1e-3)
    start = machine.q.copy()
    machine.step(500)
    exact = np.array([1.25, 2, 3 + 4 * 0.5 - G * 0.5 * 0.501 / 2])
    expect(np.allclose(machine.q[:3], exact, atol=1e-10), f"thrown: {machine.q[:3]} for {exact}")
    expect(np.allclose(machine.q[3:], [math.cos(0.5), 0, 0, math.sin(0.5)], atol=1e-6), f"turned: {machine.q[3:]}")
    expect(np.allclose(machine.v, [0.5, 0, 4 - G * 0.5, 0, 0, 2], atol=1e-9), f"rates: {machine.v}")
    expect(np.allclose(machine.velocities[0], machine.v[:3]) and np.allclose(machine.positions[0], machine.q[:3]), "link and joint")
    end = machine.q.copy()
    machine.reset()
    expect(np.array_equal(machine.q, start) and machine.time == 0, "reset")
    machine.step(500)
    expect(np.array_equal(machine.q, end), "the same again, to the bit")


def check_contacts(folder):
    """A box at rest: its contacts carry it, also where the steps are the library's."""
    for options in ({"dt": 2e-3, "height": 0.01}, {"accuracy": 1e-3, "height": 0.01}, {"accuracy": 1e-3, "height": 0.1}):
        machine = delassus.Machine(write(folder, "box.xml", BOX), ground=True, tolerance=1e-9, **options)
        impulse = sum((machine.step(), machine.contact_forces.sum(axis=0)[2] * machine.dt)[1] for _ in range(300))
        expect(abs(impulse - 1.5 * (G * machine.time + machine.v[2])) < 1e-3 * impulse, f"impulses of all steps: {impulse} {options}")
        machine.step(700)
        count = len(machine.contact_gaps)
        forces, normals = machine.contact_forces, machine.contact_normals
        expect(count >= 3 and forces.shape == (count, 3) and machine.contact_points.shape == (count, 3), f"contacts: {count}")
        expect(np.allclose(forces.sum(axis=0), [0, 0, 1.5 * G], atol=1e-5), f"weight {forces.sum(axis=0)} {options}")
        expect(np.array_equal(machine.contact_links, [[-1, 0]] * count), f"links {machine.contact_links}")
        expect(np.allclose(normals, [0, 0, 1]) and np.all(forces[:, 2] >= 0), f"normals {normals}")
        expect(np.allclose(machine.contact_points[:, 2], 0, atol=1e-4), "points")


def check_forces(folder):
    """Torque times time over inertia; what pushes a ball joint pushes its parent back."""
    machine = delassus.Machine(write(folder, "parts.xml", PARTS), dt=1e-3)
    turn, root, neck = (machine.v_index[name] for name in ("turn", "root", "neck"))
    expect(machine.joints == ["turn", "root", "neck"] == list(machine.v_index) and len(machine.v) == 10, f"joints {machine.joints}")
    machine.forces[turn] = 0.5
    machine.controls[machine.actuators.index("engine")] = 1.5
    machine.forces[neck + 1] = 0.2
    machine.step(1000)
    expect(abs(machine.v[turn] - 2 / 0.5) < 1e-6, f"wheel: {machine.v[turn]}")
    # 0.2 N m turn the head one way and the hull the other, apart by 0.2 (1 / 0.25 + 1 / 1) rad/s after 1 s.
    expect(abs(machine.v[neck + 1] - 1) < 1e-6 and abs(machine.v[root + 4] + 0.2) < 1e-6, f"neck and hull: {machine.v}")
    machine.forces = np.zeros(10)
    machine.controls[:] = 0
    machine.forces[root] = 3
    before = machine.q[machine.q_index["turn"]]
    machine.step(5000)
    expect(abs(machine.q[machine.q_index["turn"]] - before - 4 * 5) < 1e-5, "an angle counts its turns")
    expect(abs(machine.v[root] - 3 * 5 / 2) < 1e-6, f"hull and head, pushed: {machine.v[root]}")
    machine.reset()
    expect(np.all(machine.forces == 0) and np.all(machine.controls == 0), "reset lets go")
    hover = delassus.Machine(write(folder, "box.xml", BOX), dt=1e-3)
    hover.forces[:] = hover.gravity_compensation()
    hover.step(1000)
    expect(abs(hover.q[2] - 3) < 1e-9, f"held up: {hover.q[2]}")


def check_state(folder):
    """What is set is what is read, and the motion from it is that of the first time."""
    machine = delassus.Machine(write(folder, "pendulum.urdf", PENDULUM), dt=1e-3, at={"swing": 0.25})
    expect(abs(machine.q[0] - 0.25) < 1e-12, f"at: {machine.q}")
    machine.set_state(np.array([7.0]), [1])
    expect(abs(machine.q[0] - 7) < 1e-12 and abs(machine.v[0] - 1) < 1e-12, f"set: {machine.q} {machine.v}")
    machine.step(200)
    first = machine.q.copy()
    machine.set_state([7], [1.0])
    machine.step(200)
    expect(abs(machine.q[0] - first[0]) < 1e-9, "from the same state")
    machine.forces[:] = machine.gravity_compensation()
    machine.set_state([0.3], [0])
    machine.forces[:] = machine.gravity_compensation()
    machine.step(1000)
    expect(abs(machine.q[0] - 0.3) < 1e-9, f"held: {machine.q}")


def check_no_change(folder):
    """What is set to what it is goes on as it was: bodies end a step with rates that no v has, and v must keep their momentum."""
    arm = write(folder, "double.xml", DOUBLE)
    for tolerance, options in ((1e-4, {}), (1e-2, {"integrator": "midpoint"})):
        machines = [delassus.Machine(arm, dt=1e-3, tolerance=1e-12, **options) for _ in range(2)]
        for machine in machines:
            machine.set_state([1, 0.5], [5, -3])
        for _ in range(1000):
            machines[0].set_state(machines[0].q, machines[0].v)
            for machine in machines:
                machine.step()
        apart = abs(machines[0].q - machines[1].q).max()
        expect(apart < tolerance and abs(machines[0].q[0] - 1) > 1, f"set to what it is, {apart} rad apart after 1 s: {options}")


def check_order(folder):
    """Forces act along the axes halfway through a step: half of it has a quarter of the error."""
    def end(dt):
        machine = delassus.Machine(write(folder, "flying.xml", FLYING), dt=dt, integrator="midpoint", tolerance=1e-12)
        machine.set_state(machine.q, [1, 2, 3, 4, -5, 3, 2, 1, 0.5])
        machine.forces = [0.1, 0.2, 0.3, 1, 2, 3, 0.5, -1, 0.4]
        machine.step(round(0.5 / dt))
        return machine.q.copy()

    coarse, middle, fine, exact = (end(dt) for dt in (4e-3, 2e-3, 1e-3, 1e-4))
    ratios = [np.abs(a - exact).max() / np.abs(b - exact).max() for a, b in ((coarse, middle), (middle, fine))]
    expect(all(3.4 < ratio < 4.6 for ratio in ratios), f"errors fall by {ratios}")


def check_weights(folder):
    """What holds a machine at rest is what acts on it: weight taken off without an actuator, and no spring of a ball joint."""
    lifted = delassus.Machine(write(folder, "lifted.xml", LIFTED.replace("GRAVCOMP", "1").replace("STIFFNESS", "0")), dt=1e-3)
    lifted.set_state([0.8, 0, 0.6, 0], [0, 0, 0])
    lifted.step(500)
    expect(np.all(lifted.gravity_compensation() == 0) and np.abs(lifted.v).max() < 1e-9, f"a lifted link: {lifted.v}")
    sprung = delassus.Machine(write(folder, "sprung.xml", LIFTED.replace("GRAVCOMP", "0").replace("STIFFNESS", "10")), dt=1e-3)
    sprung.set_state([0.8, 0, 0.6, 0], [0, 0, 0])
    sprung.forces = sprung.gravity_compensation()
    sprung.step(500)
    expect(np.abs(sprung.v).max() < 1e-9, f"a ball joint with a spring that does not act: {sprung.v}")


def check_lock(folder):
    """Three hinges where the first and the third are all but parallel: angles go on by what can be, not by thousands of turns."""
    machine = delassus.Machine(write(folder, "three.xml", THREE), dt=1e-3)
    machine.set_state([0.3, math.pi / 2 - 1e-6, 0.1], [1, 0, 0.2])
    machine.forces[0] = 1
    machine.step()
    expect(np.abs(machine.q).max() < 8, f"three hinges: {machine.q}")


def check_end(folder):
    """A program may end while a thread of it steps."""
    write(folder, "pendulum.urdf", PENDULUM)
    program = ("import sys, threading, time; sys.path.insert(0, sys.argv[1]); import delassus; m = delassus.Machine('pendulum.urdf', dt=1e-6); "
               "threading.Thread(target=m.step, args=(10**12,), daemon=True).start(); time.sleep(0.2); print('ends')")
    done = subprocess.run([sys.executable, "-c", program, str(MODULE)], cwd=folder, capture_output=True, text=True, timeout=60)
    expect(done.returncode == 0 and done.stdout == "ends\n", f"a program that ends while a thread steps: {done}")


def check_arrays(folder):
    machine = delassus.Machine(write(folder, "pendulum.urdf", PENDULUM), dt=1e-3)
    q = machine.q
    before = q[0]
    machine.step()
    expect(machine.q is q and q[0] != before, "q is one array, which follows")
    expect_refused("read-only", q.__setitem__, 0, 1.0)
    for array in (q, machine.forces, machine.positions):
        expect_refused("does not own its data", array.resize, (0,), refcheck=False)
    many = np.array([[0.1, 5.0], [0.2, 6.0]])
    arm = delassus.Machine(write(folder, "double.xml", DOUBLE))
    arm.set_state(many[:, 0], many[::-1, 1])
    expect(np.allclose(arm.q, [0.1, 0.2]) and np.allclose(arm.v, [6, 5]), f"numbers that are not next to each other: {arm.q} {arm.v}")
    arm.forces += 1
    expect(np.all(arm.forces == 1), "forces are added to")
    del machine
    gc.collect()
    expect(math.isfinite(q[0]), "an array outlives its machine")


def check_threads(folder):
    """Others run while a machine steps, and do not step it."""
    machine = delassus.Machine(write(folder, "pendulum.urdf", PENDULUM), dt=1e-6)
    start = time.perf_counter()
    machine.step(1000)
    count = max(1000, int(1000 * 0.6 / (time.perf_counter() - start)))
    worker = threading.Thread(target=machine.step, args=(count,))
    begin, turns, refused = machine.time, 0, 0
    worker.start()
    while worker.is_alive():
        turns += 1
        try:
            machine.step(1)
        except ValueError as error:
            expect("another thread" in str(error), f"{error}")
            refused += 1
        time.sleep(0.005)
    worker.join()
    expect(turns > 5 and refused > 0, f"{turns} turns of the other thread, {refused} refused")
    expect(machine.time - begin > 0.99e-6 * count, "the steps were made")


def check_interrupt(folder):
    machine = delassus.Machine(write(folder, "pendulum.urdf", PENDULUM), dt=1e-6)

    def ring(*_):
        raise TimeoutError

    signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    start = time.perf_counter()
    try:
        machine.step(10**12)
    except TimeoutError:
        pass
    expect(time.perf_counter() - start < 10 and machine.time > 0, "an interrupt ends a call")
    machine.step(10)


def check_page(folder):
    """The program of the page holds an arm where it starts."""
    page = Path(__file__).parent.parent / "docs/how_to/use_from_python.md"
    write(folder, "arm.urdf", PENDULUM.replace("swing", "elbow"))
    os.chdir(folder)
    names = {}
    exec(page.read_text().split("```python\n")[1].split("```")[0], names)
    expect(abs(names["arm"].time - 1) < 1e-9 and abs(names["arm"].q[0] - 0.3) < 1e-9, f"the page's arm: {names['arm'].q}")


def check_refusals(folder):
    pendulum, box = write(folder, "pendulum.urdf", PENDULUM), write(folder, "box.xml", BOX)
    for said, options in (("no keyword 'seconds'", {"seconds": 3}), ("no keyword 'gravity'", {"gravity": 0}), ("a step from", {"dt": "fast"}), ("a step from", {"dt": math.nan}),
                          ("--height", {"height": 1}), ("second order", {"accuracy": 1e-3, "integrator": "euler"}), ("--accuracy", {"accuracy": 1e-3, "dt": 1e-3}),
                          ("free or fixed", {"base": "loose"}), ("no joint 'elbow'", {"at": {"elbow": 1}}), ("--hold", {"hold": [1, 2, 3]}), ("NAME=FOLDER", {"package": "x"})):
        expect_refused(said, delassus.Machine, pendulum, **options)
    expect_refused("none.xml", delassus.Machine, folder / "none.xml")
    expect_refused("broken.xml", delassus.Machine, write(folder, "broken.xml", "<mujoco><worldbody>"))
    expect_refused("keyframe 'down'", delassus.Machine, box, key="down")
    machine = delassus.Machine(write(folder, "parts.xml", PARTS), dt=1e-3)
    expect_refused("1 or more", machine.step, 0)
    expect_refused("broadcast", setattr, machine, "forces", [1, 2, 3])
    expect_refused("q must have 12 numbers", machine.set_state, machine.q[1:], machine.v)
    expect_refused("", machine.set_state, np.full(12, np.nan), machine.v)
    before = machine.q.copy()
    for array, at in ((machine.forces, 0), (machine.forces, 1), (machine.forces, 8), (machine.controls, 0)):
        array[at] = math.nan
        expect_refused("is not finite", machine.step)
        array[at] = 0
    expect(np.array_equal(machine.q, before), "what was refused moved nothing")
    expect(any("nothing holds" in note for note in delassus.Machine(box).notes), "a note of a fall")


def main():
    with tempfile.TemporaryDirectory() as name:
        for check in (check_pendulum, check_throw, check_contacts, check_forces, check_state, check_no_change, check_order, check_weights, check_lock, check_end, check_arrays, check_threads, check_interrupt, check_page, check_refusals):
            check(Path(name))
    print("check_delassus_python: all holds")


main()
