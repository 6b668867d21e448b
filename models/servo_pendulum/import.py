#!/usr/bin/env python3
"""Turns the servo pendulum's JSON logs into an experiment folder.

usage: import.py SOURCE_FOLDER EXPERIMENT_FOLDER

SOURCE_FOLDER holds the recordings (*.json: mass, length, kp, vin, trajectory, entries). Written: one
CSV per log (t [s], q [rad], w [rad/s], goal [rad], on 0|1) and experiment.yaml. Logs of the
trajectory up_and_down are for validation; where there are none, those of the last one by name.
"""
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import importer  # noqa: E402

K_T, RESISTANCE = 0.303, 3.37  # N m/A, Ohm
TICKS_PER_RAD, DUTY_DIVISOR = 4096 / (2 * math.pi), 256 * 885
MAX_GAIN = 16383  # of the firmware's register
COLUMNS = {"t": "timestamp", "q": "position", "w": "speed", "goal": "goal_position",
           "on": "torque_enable"}
MOST = {"t": importer.TIME, "q": importer.TURN, "w": (1e4, "rad/s"), "goal": importer.TURN, "on": ()}
MOST_VOLTS = 100
HELD_OUT = "up_and_down"


def servo_stiffness(firmware_gain, volts):
    """Torque per rad of error [N m/rad]: k_t/R * V * duty per rad."""
    return K_T / RESISTANCE * volts * firmware_gain * TICKS_PER_RAD / DUTY_DIVISOR


def table(log, where):
    """The entries as CSV."""
    rows, times = [",".join(COLUMNS)], []
    for k, entry in enumerate(log["entries"]):
        cells = {name: importer.number(entry[key], f"{where}: entries[{k}].{key}", *MOST[name])
                 for name, key in COLUMNS.items()}
        if cells["on"] not in (0, 1):
            importer.refuse(f"{where}: entries[{k}].{COLUMNS['on']}", "0 or 1", entry[COLUMNS["on"]])
        times.append((f"{where}: entries[{k}].{COLUMNS['t']}", cells["t"]))
        rows.append(",".join(str(int(x)) if name == "on" else repr(x) for name, x in cells.items()))
    importer.rise(times)
    if len(rows) < 3:
        importer.refuse(f"{where}: entries", "at least 2", len(rows) - 1)
    return "\n".join(rows) + "\n"


def held_out(trajectories, source):
    """The one for validation."""
    if len(trajectories) < 2:
        importer.refuse(source, "recordings of two trajectories or more, one of them to validate",
                        f"only '{next(iter(trajectories))}'")
    return HELD_OUT if HELD_OUT in trajectories else max(trajectories)


def experiment(logs, model, validate):
    lines = [
        "format: 1",
        f"model: {model}",
        "logs:",
    ]
    for name, log in logs:
        use = "validate" if log["trajectory"] == validate else "train"
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


def read(file):
    """A recording with the gains of its servo, and its entries as CSV."""
    try:
        log = json.loads(file.read_text(encoding="utf-8-sig"))
        log["kp"], log["trajectory"] = int(log["kp"]), str(log["trajectory"])
        if not 0 < log["kp"] <= MAX_GAIN:
            importer.refuse(f"{file}: kp", f"a gain of 1 to {MAX_GAIN}", log["kp"])
        importer.positive(log["vin"], f"{file}: vin", MOST_VOLTS, "V")
        return log, table(log, file)
    except (ValueError, LookupError, TypeError, RecursionError, OverflowError) as error:
        importer.refuse(file, "a recording with kp, vin, trajectory and entries", repr(error))


def convert(source, model):
    files = sorted(source.glob("*.json"))
    if not files:
        importer.refuse(source, "recordings (*.json)", "none")
    logs, tables, origin = [], {}, {}
    for file in files:
        log, rows = read(file)
        name = f"kp{log['kp']}_{log['trajectory']}"
        if not name.replace("_", "").isalnum():
            importer.refuse(f"{file}: trajectory", "a name", repr(log["trajectory"]))
        if name in origin:
            importer.refuse(file, "one recording for each gain and trajectory",
                            f"{name} again, as in {origin[name]}")
        origin[name], tables[f"{name}.csv"] = file, rows
        logs.append((name, log))
    logs.sort(key=lambda item: (item[1]["kp"], item[0]))
    validate = held_out({log["trajectory"] for _, log in logs}, source)
    return (tables | {"experiment.yaml": experiment(logs, model, validate)},
            f"{len(logs)} logs, {validate} for validation, and experiment.yaml")


if __name__ == "__main__":
    importer.run(__file__, __doc__, convert)
