"""A differential-drive robot in thirty lines: somebody else's simulator, for rift sweep."""
import argparse, json, math, random, sys

GOAL, STEP_S, TRACK_M, DELAY = (0.6, 0.25), 0.02, 0.083, 4


def drive(mu, mismatch, seed):
    """Yields t, x, y, yaw of a robot that turns towards its goal, 0.3 m/s at most."""
    noise = random.Random(seed)
    x = y = yaw = t = 0.0
    left = right = 0.0
    commands = [(0.0, 0.0)] * DELAY
    while math.hypot(GOAL[0] - x, GOAL[1] - y) > 0.03 and t < 20.0:
        yield t, x, y, yaw
        error = math.remainder(math.atan2(GOAL[1] - y, GOAL[0] - x) - yaw, 2.0 * math.pi)
        turn = max(-0.15, min(0.15, 0.2 * error + noise.gauss(0.0, 0.01)))
        commands.append((0.2 - turn, 0.2 + turn))
        asked = commands.pop(0)
        grip = 9.81 * mu * STEP_S * 0.1  # what the tyres can change of a wheel's speed in a step
        left += max(-grip, min(grip, asked[0] * (1.0 + mismatch) - left))
        right += max(-grip, min(grip, asked[1] * (1.0 - mismatch) - right))
        yaw += (right - left) / TRACK_M * STEP_S
        x += 0.5 * (left + right) * math.cos(yaw) * STEP_S
        y += 0.5 * (left + right) * math.sin(yaw) * STEP_S
        t += STEP_S


def log(mu, mismatch, seed):
    rows = list(drive(mu, mismatch, seed))
    text = "time,pose_x,pose_y,theta\n"
    text += "".join(f"{t:.3f},{1e3 * x!r},{1e3 * y!r},{yaw!r}\n" for t, x, y, yaw in rows)
    return text, rows[-1][0] < 19.9


if __name__ == "__main__" and "--serve" in sys.argv:  # persistent: a line in, a line out
    for line in sys.stdin:
        trial = json.loads(line)
        text, arrived = log(**trial["theta"], seed=trial["seed"])
        status = "ok" if arrived else "timed_out"
        print(json.dumps({"id": trial["id"], "status": status, "log": text}), flush=True)
elif __name__ == "__main__":
    parser = argparse.ArgumentParser()
    for flag, kind in (("mu", float), ("mismatch", float), ("seed", int), ("out", str)):
        parser.add_argument("--" + flag, type=kind, required=True)
    arguments = parser.parse_args()
    text, arrived = log(arguments.mu, arguments.mismatch, arguments.seed)
    open(arguments.out, "w").write(text)
    if not arrived:
        print("still driving after 20 s", file=sys.stderr)
        sys.exit(10)
