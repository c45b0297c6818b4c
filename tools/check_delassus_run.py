#!/usr/bin/env python3
"""Runs delassus_run as a user would: check_delassus_run.py PROGRAM. What it prints, writes and returns is checked."""
import csv
import math
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path

# A ball on a hinge at a metre: lets go level, and is at the lowest point after a quarter of its period.
PENDULUM = """<robot name="pendulum">
  <link name="world"/>
  <link name="rod">
    <inertial><origin xyz="1 0 0"/><mass value="2"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="swing" type="continuous"><parent link="world"/><child link="rod"/><axis xyz="0 1 0"/></joint>
</robot>
"""
BOX = """<mujoco model="box"><worldbody><body name="box" pos="0 0 3"><freejoint/><geom type="box" size="0.2 0.2 0.1" mass="1"/></body></worldbody>
<keyframe><key name="low" qpos="0 0 0.2 1 0 0 0"/></keyframe></mujoco>
"""
# A box thrown and turning, above a plane of the file's own. Without a key it stands on its edge, as high as the file says.
THROWN = """<!-- <robot name="in a comment only"> -->
<mujoco model="thrown"><worldbody><geom type="plane" size="1 1 1"/>
<body name="box" pos="0 0 3"><freejoint name="root"/><geom type="box" size="0.2 0.2 0.1" mass="1"/>
<body name="lid" pos="0 0 0.2"><joint name="lid" axis="0 1 0" range="-30 30"/><geom type="box" size="0.1 0.1 0.05" mass="0.1"/></body></body></worldbody>
<keyframe><key name="up" qpos="1 2 3 1 0 0 0 0" qvel="0.5 0 4 0 0 2 0"/><key name="open" qpos="0 0 2 1 0 0 0 1"/></keyframe></mujoco>
"""


# A wheel of 2 kg m² about z, with a motor on it.
WHEEL = """<mujoco model="wheel"><worldbody><body name="wheel"><joint name="turn" axis="0 0 1"/>
<inertial pos="0 0 0" mass="1" diaginertia="1.5 1.5 2"/></body></worldbody>
<actuator><motor name="motor" joint="turn" gear="3"/></actuator></mujoco>
"""


# Three links in a row, the first and the last of them balls that are in each other.
KNEES = """<mujoco model="knees"><worldbody><body name="thigh"><joint name="hip" axis="0 1 0"/><geom type="sphere" size="0.3" mass="1"/>
<body name="shank" pos="0.2 0 0"><joint name="knee" axis="0 1 0"/><geom type="sphere" size="0.05" mass="1"/>
<body name="foot" pos="0.2 0 0"><joint name="ankle" axis="0 1 0"/><geom type="sphere" size="0.2" mass="1"/></body></body></body></worldbody></mujoco>
"""


def last_row(path):
    return {name: float(number) for name, number in list(csv.DictReader(open(path)))[-1].items()}


def run(program, *words):
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=300)
    return done.returncode, done.stdout, done.stderr


def expect(holds, what):
    if not holds:
        sys.exit(f"check_delassus_run: {what}")


def thrown(folder):
    path = folder / "thrown.xml"
    path.write_text(THROWN)
    return path


def check_control(program, folder, out):
    """A motor that pushes from 0.1 s to 0.3 s gives the wheel the rate torque · time / inertia."""
    wheel, table = folder / "wheel.xml", folder / "control.csv"
    wheel.write_text(WHEEL)
    table.write_text("time,motor\n0.1,0.5\n0.3,0\n")
    status, text, _ = run(program, wheel, "--control", table, "--seconds", 0.5, "--dt", 0.001, "--out", out)
    expect(status == 0, f"control: {text}")
    rows = [{name: float(number) for name, number in row.items()} for row in csv.DictReader(open(out / "wheel.csv"))]
    angles = {round(row["time (s)"], 6): row["turn (rad)"] for row in rows}
    rate = (angles[0.5] - angles[0.4]) / 0.1
    expect(abs(rate - 3 * 0.5 * 0.2 / 2) < 1e-6, f"rate after the push: {rate}")
    expect(abs(angles[0.1]) < 1e-12, f"pushed too early: {angles[0.1]}")
    for wrong, said in (("time,engine\n0,1\n", "engine"), ("motor\n1\n", "must be 'time'"), ("time,motor\n0,1\n0,2\n", "does not come after"), ("time,motor\n0,nan\n", "no finite number"), ("", "no row")):
        table.write_text(wrong)
        status, _, error = run(program, wheel, "--control", table, "--seconds", 0.01, "--out", out)
        expect(status == 1 and said in error and str(table) in error, f"a wrong table: {error}")


def check_free_root(program, folder, out):
    """In flight the root's numbers are those of a throw: the centre of both bodies moves along a parabola."""
    status, text, _ = run(program, thrown(folder), "--key", "up", "--seconds", 0.5, "--dt", 0.001, "--out", out)
    expect(status == 0, f"thrown: {text}")
    row = last_row(out / "thrown.csv")
    names = [f"box.{name}" for name in ("x (m)", "y (m)", "z (m)", "qw", "qx", "qy", "qz", "vx (m/s)", "vy (m/s)", "vz (m/s)", "wx (rad/s)", "wy (rad/s)", "wz (rad/s)")]
    expect(all(name in row for name in names) and "lid (rad)" in row, f"columns of a free root: {list(row)}")
    # Kick, then drift: after n steps of h z is v t - g t (t + h)/2 from the start. It spins about its vertical axis, at which the lid sits level.
    for name, exact in ((names[0], 1.25), (names[1], 2), (names[2], 3 + 4 * 0.5 - 9.81 * 0.5 * 0.501 / 2), (names[3], math.cos(0.5)), (names[6], math.sin(0.5)),
                        (names[7], 0.5), (names[9], 4 - 9.81 * 0.5), (names[12], 2)):
        expect(abs(row[name] - exact) < 1e-3, f"{name} of the thrown box: {row[name]}, not {exact}")
    expect(abs(sum(row[name] ** 2 for name in names[3:7]) - 1) < 1e-9, "the quaternion has length 1")


def check_bases(program, folder, out):
    """A keyframe on another base, and on a floor that lifts the machine."""
    model = thrown(folder)
    status, text, _ = run(program, model, "--key", "open", "--base", "fixed", "--seconds", 0.01, "--dt", 0.001, "--out", out)
    expect(status == 0 and "the base is fixed: keyframe 'open' does not move 'root'" in text, f"a keyframe on a fixed base: {text}")
    expect("joint 'lid' starts at 1 rad, outside of its limits -0.523599 and 0.523599" in text, f"a start beyond a limit: {text}")
    expect("box.x (m)" not in last_row(out / "thrown.csv"), "a fixed root has no columns")
    status, text, _ = run(program, model, "--ground", "--seconds", 0.01, "--out", out)
    expect(status == 0 and "a floor of its own" in text and last_row(out / "thrown.csv")["box.z (m)"] > 2.9, f"two floors: {text}")
    bare = folder / "bare.xml"
    bare.write_text(THROWN.replace('<geom type="plane" size="1 1 1"/>', ""))
    # Half a height of the box is 0.1 m: there it stands whatever height the keyframe has.
    status, text, _ = run(program, bare, "--ground", "--key", "open", "--seconds", 0.002, "--dt", 0.001, "--out", out)
    expect(status == 0 and abs(last_row(out / "bare.csv")["box.z (m)"] - 0.1) < 1e-3, f"a keyframe on the floor: {text}")
    held = folder / "held.xml"
    held.write_text(THROWN.replace('<freejoint name="root"/>', "").replace('qpos="1 2 3 1 0 0 0 0" qvel="0.5 0 4 0 0 2 0"', 'qpos="0.2"').replace('qpos="0 0 2 1 0 0 0 1"', 'qpos="0.3"'))
    status, text, _ = run(program, held, "--base", "free", "--key", "up", "--seconds", 0.002, "--dt", 0.001, "--out", out)
    row = last_row(out / "held.csv")
    expect(status == 0 and abs(row["box.z (m)"] - 3) < 1e-3 and abs(row["lid (rad)"] - 0.2) < 1e-3, f"a keyframe on a freed base: {text} {row}")


def check_names(program, folder, out):
    """Files of one name in two folders, and one file twice, do not write over each other."""
    for name in ("one", "two"):
        (folder / name).mkdir()
        (folder / name / "robot.urdf").write_text(PENDULUM)
    files = [folder / "one" / "robot.urdf", folder / "two" / "robot.urdf", folder / "two" / "robot.urdf"]
    status, text, _ = run(program, *files, "--seconds", 0.1, "--quiet", "--out", out)
    expect(status == 0 and all((out / f"{name}.csv").exists() for name in ("one_robot", "two_robot", "two_robot_2")), f"equal names: {text}")


def check_what_it_says(program, folder, out):
    welded = folder / "welded.urdf"
    tip = """<link name="tip"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><mesh filename="package://hand/tip.stl"/></geometry></collision></link>
    <joint name="held" type="fixed"><parent link="rod"/><child link="tip"/></joint></robot>"""
    welded.write_text(PENDULUM.replace("</robot>", tip))
    status, text, _ = run(program, welded, "--seconds", 0.1, "--out", out)
    expect(status == 0 and "a fixed joint holds move as one" in text, f"links in one body: {text}")
    expect("--meshes and --package say where to look" in text and "UrdfOptions" not in text, f"a mesh that is not there: {text}")
    (folder / "hand").mkdir()
    (folder / "hand" / "tip.stl").write_text("solid t\n" + "".join(f"facet normal 0 0 0\nouter loop\n{''.join(f'vertex {v}' + chr(10) for v in f)}endloop\nendfacet\n" for f in
        (("0 0 0", "0 1 0", "1 0 0"), ("0 0 0", "1 0 0", "0 0 1"), ("0 0 0", "0 0 1", "0 1 0"), ("1 0 0", "0 1 0", "0 0 1"))) + "endsolid t\n")
    status, text, _ = run(program, welded, "--package", f"hand={folder / 'hand'}", "--seconds", 0.1, "--out", out)
    expect(status == 0 and "not read" not in text, f"a package: {text}")
    model = thrown(folder)
    status, text, _ = run(program, model, "--audit", "--quiet", "--seconds", 2, "--out", out)
    rows = {line.split("  ")[0] + " " + name: line for line in text.splitlines() for name in ("Contact<Coulomb>", "Limit<Turn> of joint 'lid'", "'box'") if name in line}
    expect(status == 0 and " acted " in rows.get("contact Contact<Coulomb>", "") and any("'box'" in line for line in rows.values()), f"what acted: {text}")
    status, text, _ = run(program, model, "--accuracy", 1e-3, "--audit", "--seconds", 2, "--out", out)
    expect(status == 0 and "inner steps" in text and "What set the size of the steps" in text and "impact" in text, f"a kept error: {text}")
    status, text, _ = run(program, model, "--integrator", "midpoint", "--seconds", 0.1, "--out", out)
    expect(status == 0 and "ImplicitMidpoint" in text, f"another integrator: {text}")
    pendulum = folder / "pendulum.urdf"
    status, text, _ = run(program, pendulum, "--study", "--quiet", "--seconds", 0.5, "--budget", 1e-3, "--out", out)
    expect(status == 0 and "cheapest within 0.001 m" in text and (out / "pendulum.study.svg").exists() and (out / "pendulum.study.csv").exists(), f"a study: {text}")
    expect("loops of this program alone" in text, f"a study says what it compares: {text}")
    command = next(line.split() for line in text.splitlines() if line.strip().startswith("./run machine"))
    status, text, _ = run(program, *command[2:], "--seconds", 0.5, "--quiet", "--out", out)
    expect(status == 0, f"the command that a study names: {command} {text}")


def check_start(program, folder, out):
    """What a run begins from: within limits, and with a word on what falls. An angle counts its turns."""
    low = folder / "low.xml"
    low.write_text(THROWN.replace('range="-30 30"', 'range="10 30"').replace('<geom type="plane" size="1 1 1"/>', ""))
    status, text, _ = run(program, low, "--seconds", 0.005, "--out", out)
    expect(status == 0 and "joint 'lid' starts at its limit 0.174533 rad, since the file's 0 is outside of 0.174533 and 0.523599" in text, f"a start within limits: {text}")
    row = last_row(out / "low.csv")
    # It begins at rest: after one step of free fall both bodies have g h, and the lid has not turned.
    mass = 1.1
    expect(abs(row["lid (rad)"] - 0.174533) < 1e-6 and abs(row["kinetic energy (J)"] - mass * (9.81 * 0.005) ** 2 / 2) < 1e-9, f"no push at the start: {row}")
    expect("nothing holds 'box' and there is no floor: it falls; --base fixed holds it, --ground adds a floor" in text, f"what falls: {text}")
    status, text, _ = run(program, low, "--ground", "--seconds", 0.005, "--out", out)
    expect(status == 0 and "it falls" not in text, f"on a floor nothing falls: {text}")
    wheel, table = folder / "wheel.xml", folder / "control.csv"
    wheel.write_text(WHEEL), table.write_text("time,motor\n0,20\n")
    status, text, _ = run(program, wheel, "--control", table, "--seconds", 2, "--dt", 0.001, "--out", out)
    # Kick, then drift under 30 rad/s^2: 30 t (t + h)/2.
    expect(status == 0 and abs(last_row(out / "wheel.csv")["turn (rad)"] - 30 * 2 * 2.001 / 2) < 1e-4, f"nine turns: {last_row(out / 'wheel.csv')}")
    expect("gaps of joints up to" in text and "overlaps up to" in text, f"the last line: {text}")
    for words, said in ((("--base", "loose"), "'loose' is not free or fixed"), (("--accuracy", "1e-3", "--integrator", "euler"), "takes an integrator of second order")):
        status, text, error = run(program, wheel, *words, "--out", out)
        expect(status not in (0, 1) and said in text + error, f"{words}: {text} {error}")


FINGERS = """<robot name="fingers">
  <link name="world"/>
  LINKS
  <joint name="lead" type="revolute"><parent link="world"/><child link="one"/><axis xyz="0 0 1"/><limit lower="3" upper="5" effort="50" velocity="9"/></joint>
  <joint name="follow" type="revolute"><parent link="world"/><child link="two"/><origin xyz="0 3 0"/><axis xyz="0 0 1"/><limit lower="-9" upper="9" effort="50" velocity="9"/><mimic joint="lead" multiplier="-0.5" offset="0.25"/></joint>
</robot>
""".replace("LINKS", "".join(f'<link name="{name}"><inertial><origin xyz="0.1 0 0"/><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>' for name in ("one", "two")))


def check_held(program, folder, out):
    """Joints that start where the user says, and hold there; a table moves what they hold."""
    pendulum, table = folder / "pendulum.urdf", folder / "hold.csv"
    words = (pendulum, "--at", "swing=0.5", "--hold", "500,40", "--seconds", 4, "--dt", 0.002, "--quiet", "--out", out)

    def balance(asked):  # 500 (q - asked) = m g l cos q
        q = asked
        for _ in range(99):
            q = asked + 19.62 * math.cos(q) / 500
        return q

    status, text, _ = run(program, *words)
    rows = [float(row["swing (rad)"]) for row in csv.DictReader(open(out / "pendulum.csv"))]
    expect(status == 0 and abs(rows[0] - 0.5) < 1e-3 and abs(rows[-1] - balance(0.5)) < 1e-5, f"a joint that holds: {rows[0]} {rows[-1]}, not {balance(0.5)}")
    table.write_text("time,swing\n0.5,7\n")
    status, text, _ = run(program, *words, "--control", table)
    expect(status == 0 and abs(last_row(out / "pendulum.csv")["swing (rad)"] - balance(7)) < 1e-5, f"what it holds moves by a turn: {last_row(out / 'pendulum.csv')}")
    status, text, _ = run(program, *words[:1], "--at", "swing=7", "--seconds", 0.004, "--dt", 0.002, "--out", out)
    expect(status == 0 and abs(last_row(out / "pendulum.csv")["swing (rad)"] - 7) < 1e-3, f"a start after a turn: {last_row(out / 'pendulum.csv')}")
    fingers = folder / "fingers.urdf"
    fingers.write_text(FINGERS)
    status, text, _ = run(program, fingers, "--at", "lead=4", "--seconds", 0.5, "--out", out)
    row = last_row(out / "fingers.csv")
    expect(status == 0 and "outside" not in text and abs(row["lead (rad)"] - 4) < 1e-6 and abs(row["follow (rad)"] - (0.25 - 0.5 * 4)) < 1e-6, f"within limits beyond half a turn, with what follows: {text} {row}")
    status, text, _ = run(program, fingers, "--at", "lead=2", "--seconds", 0.01, "--out", out)
    expect(status == 0 and "joint 'lead' starts at 2 rad, outside of its limits 3 and 5" in text, f"a start beyond a limit: {text}")
    # A cap of 50 N·m on a servo that is asked for a far place: 50 / 0.11 rad/s² with the rotor's share of the other finger, whose rate is half.
    table.write_text("time,lead\n0,1000\n")
    status, text, _ = run(program, fingers, "--at", "lead=3.1", "--hold", "1e4,0", "--control", table, "--seconds", 0.02, "--dt", 0.001, "--out", out)
    inertia, t = 0.11 * (1 + 0.5 ** 2), 0.02
    expect(status == 0 and abs(last_row(out / "fingers.csv")["lead (rad)"] - (3.1 + 50 / inertia * t * (t + 0.001) / 2)) < 1e-6, f"the cap of a servo: {last_row(out / 'fingers.csv')}")
    box = folder / "box.xml"
    status, text, _ = run(program, box, "--ground", "--height", 0.5, "--seconds", 0.01, "--dt", 0.001, "--out", out)
    expect(status == 0 and abs(last_row(out / "box.csv")["box.z (m)"] - (0.6 - 9.81 * 0.01 * 0.011 / 2)) < 1e-9, f"a height: {last_row(out / 'box.csv')}")
    wheel = folder / "wheel.xml"
    wheel.write_text(WHEEL.replace('gear="3"', 'gear="3" ctrllimited="true" ctrlrange="-1 2"')), table.write_text("time,motor\n0,1\n0.1,5\n0.2,6\n")
    status, text, _ = run(program, wheel, "--control", table, "--seconds", 0.01, "--out", out)
    expect(status == 0 and "5 for 'motor' at 0.1 s is beyond its range, -1 to 2, and counts as its end" in text and text.count("beyond its range") == 1, f"a control that is clamped: {text}")
    status, text, _ = run(program, wheel, "--hold", 10, "--seconds", 0.01, "--out", out)
    expect(status == 0 and "no joint is left for --hold" in text, f"nothing to hold: {text}")
    for words, said in ((("--at", "lead"), "write JOINT=PLACE"), (("--at", "lead=nan"), "write JOINT=PLACE"), (("--at", "thumb=1"), "there is no joint 'thumb'; there is 'lead', 'follow'"),
                        (("--at", "follow=1"), "follows another"), (("--hold", "-1"), "-1"), (("--hold", "1,2,3"), "3"), (("--height", "1"), "ground"), (("--hold", "nan"), "nan")):
        status, text, error = run(program, fingers, *words, "--out", out)
        expect(status != 0 and said in text + error and (text + error).count("\n") < 4, f"{words}: {status} {text} {error}")


def check_overlaps(program, folder, out):
    """Links that are in each other as a run begins do not collide, unless the user says so."""
    knees = folder / "knees.xml"
    knees.write_text(KNEES)
    for more, ending, pushed in ([], "do not collide; --push-apart lets them", False), (["--push-apart"], "are pushed apart", True):
        status, text, _ = run(program, knees, "--seconds", 0.005, "--out", out, *more)
        expect(status == 0, f"overlaps: {text}")
        expect(f"links 'thigh' and 'foot' are 0.1 m in each other at the start, and {ending}" in text, f"overlaps: {text}")
        expect((last_row(out / "knees.csv")["contacts"] > 0) == pushed, f"overlaps: contacts by {more}")


def check_vtk(program, box, out):
    status, text, _ = run(program, box, "--ground", "--vtk", "--seconds", 0.5, "--frames", 10, "--quiet", "--out", out)
    files = [data.get("file") for data in ET.parse(out / "box.pvd").getroot().find("Collection")]
    expect(status == 0 and len(files) == 5 and all(ET.parse(out / file).getroot().get("type") == "PolyData" for file in files), f"VTK: {text} {files}")


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        pendulum, box, bad, out = (Path(folder, name) for name in ("pendulum.urdf", "box.xml", "bad.urdf", "out"))
        pendulum.write_text(PENDULUM), box.write_text(BOX), bad.write_text(PENDULUM.replace('value="2"', 'value="nan"'))
        status, text, _ = run(program, pendulum, "--seconds", 1, "--dt", 0.001, "--out", out)
        rows = list(csv.DictReader(open(out / "pendulum.csv")))
        expect(status == 0 and len(rows) == 1000, f"the pendulum: {status} {text}")
        # I = 2.01 kg m2, m g l = 19.62 N m: energy at the lowest point is 19.62 J, reached once in 0.6 s.
        kinetic = [float(row["kinetic energy (J)"]) for row in rows]
        lowest = max(range(1000), key=lambda k: kinetic[k])
        expect(abs(kinetic[lowest] - 19.62) < 0.1, f"energy at the lowest point: {kinetic[lowest]}")
        expect(abs(abs(float(rows[lowest]["swing (rad)"])) - 1.5708) < 0.01, f"angle there: {rows[lowest]}")
        page = (out / "pendulum.html").read_text()
        expect("<html" in page and "pendulum" in page, "the page")
        status, text, _ = run(program, box, pendulum, "--ground", "--quiet", "--seconds", 1, "--out", out)
        expect(status == 0 and (out / "box.html").exists() and "box: 1 link, 1 joint, 200 steps, 0 not converged" in text, f"a box: {text}")
        last = list(csv.DictReader(open(out / "box.csv")))[-1]
        expect(int(last["contacts"]) == 4 and float(last["kinetic energy (J)"]) < 1e-6, f"the box stands where it was set down: {last}")
        status, text, _ = run(program, box, "--ground", "--key", "low", "--seconds", 1, "--out", out)
        last = list(csv.DictReader(open(out / "box.csv")))[-1]
        expect(status == 0 and int(last["contacts"]) == 4, f"from a keyframe: {last}")
        status, _, error = run(program, box, "--key", "high", "--out", out)
        expect(status == 1 and "has no keyframe 'high'; it has 'low'" in error, f"a keyframe that is not there: {status} {error}")
        status, _, error = run(program, bad, "--out", out)
        expect(status == 1 and "bad.urdf:4" in error, f"a bad number: {status} {error}")
        check_control(program, Path(folder), out)
        check_start(program, Path(folder), out)
        check_held(program, Path(folder), out)
        check_overlaps(program, Path(folder), out)
        check_free_root(program, Path(folder), out)
        check_bases(program, Path(folder), out)
        check_names(program, Path(folder), out)
        check_what_it_says(program, Path(folder), out)
        check_vtk(program, box, out)
        for words in ([], ["nowhere.urdf"], [box, "--dt", "-1"], [box, "--base", "flying"], [box, "--fast"]):
            status, text, error = run(program, *words)
            expect(status not in (0, 1) and (text + error).strip(), f"{words}: {status} {text} {error}")
        numbers = [("--seconds", word) for word in ("nan", "inf", "1e300", "0", "-1", "x")] + [("--dt", "nan"), ("--dt", "20"), ("--tolerance", "nan"),
                   ("--friction", "-1"), ("--accuracy", "0.5"), ("--accuracy", "nan"), ("--budget", "0"), ("--frames", "0"), ("--package", "x")]
        for words in [(*pair,) for pair in numbers] + [("--dt", "1", "--seconds", "0.5"), ("--seconds", "1e6", "--dt", "1e-9"), ("--dt", "0.01", "--accuracy", "1e-3")]:
            status, text, error = run(program, box, *words, "--out", out)
            expect(status not in (0, 1) and (text + error).strip(), f"{words}: {status} {text} {error}")
    print("delassus_run: all as it should be")


if __name__ == "__main__":
    main()
