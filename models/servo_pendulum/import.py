#!/usr/bin/env python3
"""Turns the servo pendulum's JSON logs into an experiment folder.

usage: import.py SOURCE_FOLDER EXPERIMENT_FOLDER

SOURCE_FOLDER holds the recordings (*.json: mass, length, kp, vin, trajectory, entries). Written: one
CSV per log (t [s], q [rad], w [rad/s], goal [rad], on 0|1) and experiment.yaml. Logs of the
trajectory up_and_down are for validation.
"""
import json
import math
import os
import pathlib
import sys

K_T, RESISTANCE = 0.303, 3.37  # N m/A, Ohm
TICKS_PER_RAD, DUTY_DIVISOR = 4096 / (2 * math.pi), 256 * 885
COLUMNS = {"t": "timestamp", "q": "position", "w": "speed", "goal": "goal_position",
           "on": "torque_enable"}


def refuse(message):
    print(f"import.py: {message}", file=sys.stderr)
    sys.exit(2)


def servo_stiffness(firmware_gain, volts):
    """Torque per rad of error [N m/rad]: k_t/R * V * duty per rad."""
    return K_T / RESISTANCE * volts * firmware_gain * TICKS_PER_RAD / DUTY_DIVISOR


def write_log(log, path):
    rows = [",".join(COLUMNS)]
    for entry in log["entries"]:
        rows.append(",".join(repr(float(entry[key])) if name != "on" else str(int(entry[key]))
                             for name, key in COLUMNS.items()))
    path.write_text("\n".join(rows) + "\n")


def experiment(logs, model):
    lines = [
        "format: 1",
        f"model: {model}",
        "logs:",
    ]
    for name, log in logs:
        use = "validate" if log["trajectory"] == "up_and_down" else "train"
        stiffness = servo_stiffness(log["kp"], log["vin"])
        stall = K_T / RESISTANCE * log["vin"]
        lines.append(f"  - {{file: {name}.csv, trial: {log['trajectory']}, use: {use}, "
                     f"condition: kp{log['kp']},")
        lines.append(f"     set: {{\"actuator:servo\": {{kp: {stiffness:.8g}, "
                     f"\"forcerange[0]\": {-stall:.8g}, \"forcerange[1]\": {stall:.8g}}}}}}}")
    lines += [
        "time: {column: t, unit: s}",
        "start: measured",
        "inputs:",
        "  - {column: goal, unit: rad, actuator: servo, enable: on}",
        "  - {actuator: back_emf, enable: on}",
        "outputs:",
        "  - {column: q, unit: rad, sensor: q}",
        "parameters:",
        "  - {name: torque, target: \"actuator:servo\", attribute: force_scale, operation: scale,"
        " initial: 1, lower: 0.3, upper: 3}",
        "  - {name: back_emf, target: \"actuator:back_emf\", attribute: \"biasprm[2]\","
        " lower: -0.2, upper: 0}",
        "  - {name: tau_c, target: \"plugin:friction\", attribute: tau_c, lower: 0, upper: 0.3}",
        "  - {name: b, target: \"joint:q\", attribute: damping, lower: 0, upper: 0.1}",
        "  - {name: armature, target: \"joint:q\", attribute: armature, lower: 1e-5, upper: 0.02}",
        "  - {name: offset, target: \"joint:q\", attribute: ref, lower: -0.1, upper: 0.1}",
        "candidates: [stribeck, {effect: load_friction}, position_friction, dahl, backlash, dead_time,"
        " payload]",
        "loss: {soft_l1: 0.005}",
        "folds: [condition, trial]",
    ]
    return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 3:
        refuse("expected SOURCE_FOLDER EXPERIMENT_FOLDER, found "
               f"{len(sys.argv) - 1} argument{'' if len(sys.argv) == 2 else 's'}")
    source, target = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    files = sorted(source.glob("*.json"))
    if not files:
        refuse(f"{source}: expected recordings (*.json), found none")
    target.mkdir(parents=True, exist_ok=True)
    logs = []
    for file in files:
        try:
            log = json.loads(file.read_text())
            name = f"kp{log['kp']}_{log['trajectory']}"
            servo_stiffness(log["kp"], log["vin"])
            write_log(log, target / f"{name}.csv")
        except (ValueError, LookupError, TypeError) as error:
            refuse(f"{file}: expected a recording with kp, vin, trajectory and entries, found {error!r}")
        logs.append((name, log))
    logs.sort(key=lambda item: (item[1]["kp"], item[0]))
    model = os.path.relpath(pathlib.Path(__file__).parent / "servo_pendulum.xml", target)
    (target / "experiment.yaml").write_text(experiment(logs, model))
    print(f"{len(logs)} logs and experiment.yaml in {target}")


if __name__ == "__main__":
    try:
        main()
    except OSError as error:
        refuse(f"{error.filename}: {error.strerror}")
