#!/usr/bin/env python3
"""The tasks of search_study by Optuna (python3-optuna): TPE and CMA-ES.

  search_peers.py BUILD/benchmarks/search_study [--seeds N] [--budget 2000] [--only TASK,...]
                  [--with tpe,optuna-cma]

Losses come from `search_study --serve`; seeds and lines are those of `search_study --each`, for
search_table.py. Neither sampler knows its budget: the first evaluations of a long run are a short one.
"""
import argparse
import subprocess

import optuna

KINDS = {"0": "continuous", "1": "integer", "2": "categorical"}


def run(study_program, task, seed, budget, sampler_name):
    """Evaluations until the target (None: not reached), and the least loss."""
    server = subprocess.Popen([study_program, "--serve", task, str(seed)], text=True,
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    words = server.stdout.readline().split()
    axes = [(words[i], KINDS[words[i + 1]], float(words[i + 2]), float(words[i + 3]))
            for i in range(0, len(words) - 1, 4)]
    target = float(words[-1])
    seen = {"n": 0, "best": float("inf"), "reached": None}

    def loss(trial):
        point = []
        for name, kind, low, high in axes:
            if kind == "continuous":
                point.append(trial.suggest_float(name, low, high))
            elif kind == "integer":
                point.append(trial.suggest_int(name, int(low), int(high)))
            else:
                point.append(trial.suggest_categorical(name, list(range(int(high) + 1))))
        server.stdin.write(" ".join(repr(float(x)) for x in point) + "\n")
        server.stdin.flush()
        value = float(server.stdout.readline())
        seen["n"] += 1
        seen["best"] = min(seen["best"], value)
        if seen["best"] <= target and seen["reached"] is None:
            seen["reached"] = seen["n"]
            trial.study.stop()
        return value

    make = {"tpe": optuna.samplers.TPESampler, "optuna-cma": optuna.samplers.CmaEsSampler}
    study = optuna.create_study(sampler=make[sampler_name](seed=1000 + seed))
    study.optimize(loss, n_trials=budget)
    server.stdin.close()
    server.wait()
    return seen


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seeds", type=int, default=50)
    parser.add_argument("--first-seed", type=int, default=1)
    parser.add_argument("--budget", type=int, default=2000)
    parser.add_argument("--only",
                        default="rastrigin,rosenbrock,ellipsoid,peaks,deceiving,flat,robot")
    parser.add_argument("--with", dest="samplers", default="tpe,optuna-cma")
    arguments = parser.parse_args()
    optuna.logging.set_verbosity(optuna.logging.ERROR)
    for task in arguments.only.split(","):
        for sampler in arguments.samplers.split(","):
            for seed in range(arguments.first_seed, arguments.first_seed + arguments.seeds):
                seen = run(arguments.program, task, seed, arguments.budget, sampler)
                print(f"{task} {sampler} {arguments.budget} seed {seed}"
                      f" reached {seen['reached'] or '-'} of {seen['n']} best {seen['best']:.6g}",
                      flush=True)


if __name__ == "__main__":
    main()
