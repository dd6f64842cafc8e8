#!/usr/bin/env python3
"""Successes, their 95 % interval and the expected running time from lines of `--each`.

  search_study --budgets 2000 --each > runs.txt
  search_peers_study --budgets 2000 --each >> runs.txt
  search_peers.py BUILD/benchmarks/search_study >> runs.txt
  search_table.py runs.txt [--budgets 100,500,2000] [--seeds 1-50]

A run of a larger budget counts at a smaller one by its first evaluations, unless there is one of that
budget. ERT = all evaluations / successes. "in common": of the seeds that one of them alone succeeds
with, how many are the portfolio's.
"""
import argparse
import collections
import math
import re

EACH = re.compile(r"(\S+) (\S+) (\d+) seed (\d+) reached (\d+|-) of (\d+) best (\S+)$")


def clopper_pearson(successes, runs):
    """The exact 95 % interval of a share."""
    def at_least(k, share):
        return sum(math.comb(runs, i) * share**i * (1 - share)**(runs - i)
                   for i in range(k, runs + 1))

    def solve(k, wanted):
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (low, middle) if at_least(k, middle) > wanted else (middle, high)
        return low

    return (solve(successes, 0.025) if successes else 0.0,
            solve(successes + 1, 0.975) if successes < runs else 1.0)


def read(paths):
    """{task: {method: {budget: {seed: (reached or None, evaluations)}}}}"""
    runs = collections.defaultdict(lambda: collections.defaultdict(
        lambda: collections.defaultdict(dict)))
    for path in paths:
        with open(path, encoding="utf-8") as lines:
            for line in lines:
                found = EACH.match(line.strip())
                if not found:
                    continue
                task, method, budget, seed, reached, spent, _ = found.groups()
                runs[task][method][int(budget)][int(seed)] = (
                    None if reached == "-" else int(reached), int(spent))
    return runs


def within(by_budget, budget):
    """{seed: (reached, spent)} of the shortest runs that are long enough."""
    long_enough = [b for b in by_budget if b >= budget]
    if not long_enough:
        return {}
    return {seed: (reached if reached and reached <= budget else None, min(spent, budget))
            for seed, (reached, spent) in by_budget[min(long_enough)].items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+")
    parser.add_argument("--budgets", default="100,500,2000")
    parser.add_argument("--seeds", default="1-50", help="first-last of the seeds that count")
    arguments = parser.parse_args()
    first, last = map(int, arguments.seeds.split("-"))
    for task, methods in read(arguments.files).items():
        for budget in map(int, arguments.budgets.split(",")):
            ours = within(methods.get("portfolio", {}), budget)
            for method, by_budget in methods.items():
                all_runs = within(by_budget, budget)
                chosen = {s: r for s, r in all_runs.items() if first <= s <= last}
                if not chosen:
                    continue
                hits = {s for s, r in chosen.items() if r[0]}
                spent = sum(r[0] or r[1] for r in chosen.values())
                low, high = clopper_pearson(len(hits), len(chosen))
                ert = f"{spent / len(hits):9.0f}" if hits else "        -"
                mine = {s for s in chosen if s in ours and ours[s][0]}
                common = [s for s in chosen if s in ours]
                alone = sum(s in mine and s not in hits for s in common)
                other = sum(s in hits and s not in mine for s in common)
                paired = "" if method == "portfolio" else f"  in common {alone} of {alone + other}"
                print(f"{task:<11} {method:<10} {budget:>6} {len(hits):>4}/{len(chosen):<4}"
                      f" [{low:.2f}, {high:.2f}] {ert}{paired}")


if __name__ == "__main__":
    main()
