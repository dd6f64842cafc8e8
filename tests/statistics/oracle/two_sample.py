#!/usr/bin/env python3
"""A classifier two-sample test of unequal samples with gaps, by definition.

Written with NumPy and SciPy from the comments of include/rift/statistics/two_sample.hpp,
two_sample_options.hpp and bootstrap.hpp, and shares no code with rift. Writes observations.csv (drawn
here) and two_sample.csv beside itself; run it by hand, only when the definition changes. Debian:
python3-numpy, python3-scipy.
"""

import pathlib

import numpy as np
from scipy import optimize, special, stats

HERE = pathlib.Path(__file__).parent
RIDGE, FOLDS = 0.7, 4
GROUPS = 7
SHUFFLES, RESAMPLES = 2000, 200_000

draw = np.random.default_rng(20261128)


def observations():
    """Groups of 3 to 9, most of the second sample; the second feature tells, the third is constant."""
    features, is_first, group = [], [], []
    for g in range(GROUPS):
        level = draw.normal(0.0, 2.0)
        for k in range(3 + (5 * g) % 7):
            first = k % 3 == 0
            row = [draw.normal(level), draw.normal(100.0 + 9.0 * first, 10.0), 4.25,
                   0.01 * draw.normal() ** 2]
            if (k + g) % 5 == 4:
                row[3] = np.nan
            features.append(row)
            is_first.append(first)
            group.append(g)
    return np.array(features), np.array(is_first), np.array(group)


def balanced(is_first):
    """Each sample weighs as many observations as the smaller one has."""
    count = np.where(is_first, is_first.sum(), (~is_first).sum())
    return count.min() / count


def standardiser(features, is_first):
    """By weighted mean and deviation of what is known; what is not known is the mean."""
    weights = balanced(is_first)[:, None] * ~np.isnan(features)
    mean = np.nansum(weights * features, axis=0) / weights.sum(axis=0)
    deviation = np.sqrt(np.nansum(weights * (features - mean) ** 2, axis=0) / weights.sum(axis=0))
    scale = np.where(deviation > 1e-9, deviation, np.inf)
    return lambda some: np.nan_to_num((some - mean) / scale)


def fit(features, is_first):
    """Weights and intercept of the logistic regression with the ridge penalty on the weights."""
    standard = standardiser(features, is_first)
    x, w = np.column_stack([standard(features), np.ones(len(features))]), balanced(is_first)

    def loss(beta):
        scores = x @ beta
        value = w @ (np.logaddexp(0.0, scores) - is_first * scores) + 0.5 * RIDGE * beta[:-1] @ beta[:-1]
        slope = x.T @ (w * (special.expit(scores) - is_first))
        slope[:-1] += RIDGE * beta[:-1]
        return value, slope

    found = optimize.minimize(loss, np.zeros(x.shape[1]), jac=True, method="BFGS",
                              options={"gtol": 1e-10, "maxiter": 1000})
    return found.x, standard


def told_right(features, is_first, group):
    """Group g is in fold g modulo the folds, and told by a classifier of all other folds."""
    right = np.zeros(len(features))
    for fold in range(FOLDS):
        tried = group % FOLDS == fold
        beta, standard = fit(features[~tried], is_first[~tried])
        scores = standard(features[tried]) @ beta[:-1] + beta[-1]
        right[tried] = (scores > 0) == is_first[tried]
    return right


def accuracy(right, is_first):
    return 0.5 * (right[is_first].mean() + right[~is_first].mean())


def interval(right, is_first, group):
    """Groups drawn anew, and the quantiles by which so few of them are not too narrow."""
    of_group = lambda values: np.array([values[group == g].sum() for g in range(GROUPS)])
    sums = [of_group(v) for v in (right * is_first, is_first, right * ~is_first, ~is_first)]
    drawn = np.random.default_rng(7).integers(0, GROUPS, (RESAMPLES, GROUPS))
    a, n, b, m = (s[drawn].sum(axis=1) for s in sums)
    tail = stats.norm.cdf(-np.sqrt(GROUPS / (GROUPS - 1)) * stats.t.ppf(0.975, GROUPS - 1))
    return np.quantile(0.5 * (a / n + b / m), [tail, 1.0 - tail])


def main():
    features, is_first, group = observations()
    with open(HERE / "observations.csv", "w") as out:
        out.write("group,is_first,a,b,c,d\n")
        for row, first, g in zip(features, is_first, group):
            out.write(f"{g},{int(first)}," + ",".join(repr(float(v)) for v in row) + "\n")
    right = told_right(features, is_first, group)
    measured = accuracy(right, is_first)
    values = {"first": is_first.sum(), "second": (~is_first).sum(), "groups": GROUPS,
              "accuracy": measured}
    values["low"], values["high"] = interval(right, is_first, group)
    as_large = 0
    for _ in range(SHUFFLES):
        shuffled = is_first.copy()
        for g in range(GROUPS):
            shuffled[group == g] = draw.permutation(is_first[group == g])
        as_large += accuracy(told_right(features, shuffled, group), shuffled) >= measured
    values["p"] = as_large / SHUFFLES
    weights = fit(features, is_first)[0]
    for k, name in enumerate("abcd"):
        alone = told_right(features[:, [k]], is_first, group)
        values[f"{name}/accuracy"] = accuracy(alone, is_first)
        values[f"{name}/low"], values[f"{name}/high"] = interval(alone, is_first, group)
        values[f"{name}/weight"] = weights[k]
    text = "".join(f"{field},{float(value)!r}\n" for field, value in values.items())
    (HERE / "two_sample.csv").write_text("field,value\n" + text)


if __name__ == "__main__":
    main()
