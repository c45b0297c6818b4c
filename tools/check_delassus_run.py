#!/usr/bin/env python3
"""Runs delassus_run as a user would: check_delassus_run.py PROGRAM. What it prints, writes and returns is checked."""
import csv
import subprocess
import sys
import tempfile
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


def run(program, *words):
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=300)
    return done.returncode, done.stdout, done.stderr


def expect(holds, what):
    if not holds:
        sys.exit(f"check_delassus_run: {what}")


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
        expect(status == 0 and (out / "box.html").exists() and "box: 1 bodies, 1 joints, 200 steps, 0 not converged" in text, f"a box: {text}")
        last = list(csv.DictReader(open(out / "box.csv")))[-1]
        expect(int(last["contacts"]) == 4 and float(last["kinetic energy (J)"]) < 1e-6, f"the box stands where it was set down: {last}")
        status, text, _ = run(program, box, "--ground", "--key", "low", "--seconds", 1, "--out", out)
        last = list(csv.DictReader(open(out / "box.csv")))[-1]
        expect(status == 0 and int(last["contacts"]) == 4, f"from a keyframe: {last}")
        status, _, error = run(program, box, "--key", "high", "--out", out)
        expect(status == 1 and "has no keyframe 'high'; it has 'low'" in error, f"a keyframe that is not there: {status} {error}")
        status, _, error = run(program, bad, "--out", out)
        expect(status == 1 and "bad.urdf:4" in error, f"a bad number: {status} {error}")
        for words in ([], ["nowhere.urdf"], [box, "--dt", "-1"], [box, "--base", "flying"], [box, "--fast"]):
            status, text, error = run(program, *words)
            expect(status not in (0, 1) and (text + error).strip(), f"{words}: {status} {text} {error}")
    print("delassus_run: all as it should be")


if __name__ == "__main__":
    main()
