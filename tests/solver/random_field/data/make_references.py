#!/usr/bin/env python3
"""Reference values of correlations, kriging and Karhunen-Loeve shares by GSTools and OpenTURNS, which the tests compare with.

usage: make_references.py     writes correlations.csv, kriging.csv and shares.csv beside this file
Needs numpy, gstools and openturns (pip install); the tables name the versions that made them. The tests need none of these packages.
"""
import csv
import math
import pathlib

import gstools as gs
import numpy as np
import openturns as ot

HERE = pathlib.Path(__file__).resolve().parent
VERSIONS = f"# gstools {gs.__version__}, openturns {ot.__version__}, numpy {np.__version__}"


def gstools_model(family, ell_x, ell_y, dip_deg, variance=1.0):
    """The model of GSTools with our correlation: exp(-r^2) for the Gaussian, sqrt(2 nu) r in the Matern. Its angle turns counter-clockwise, a dip clockwise."""
    common = {"dim": 2, "var": variance, "len_scale": [ell_x, ell_y], "angles": -math.radians(dip_deg)}
    if family == "exponential_isotropic":
        return gs.Exponential(**common, rescale=1.0)
    if family == "squared_exponential":
        return gs.Gaussian(**common, rescale=1.0)
    if family == "matern_3_2":
        return gs.Matern(**common, nu=1.5, rescale=math.sqrt(2))
    if family == "matern_5_2":
        return gs.Matern(**common, nu=2.5, rescale=math.sqrt(2))
    return None


def openturns_correlation(family, ell_x, ell_y, x, y):
    """Along the axes of the bedding."""
    at = [x, y]
    if family == "exponential":
        return ot.AbsoluteExponential([ell_x, ell_y]).computeAsScalar(at)
    if family == "exponential_isotropic":
        return ot.ExponentialModel([ell_x, ell_y], [1.0]).computeAsScalar(at)
    if family == "squared_exponential":
        return ot.SquaredExponential([ell_x / math.sqrt(2), ell_y / math.sqrt(2)], [1.0]).computeAsScalar(at)
    if family in ("matern_3_2", "matern_5_2"):
        return ot.MaternModel([ell_x, ell_y], [1.0], 1.5 if family == "matern_3_2" else 2.5).computeAsScalar(at)
    damped = [ot.ExponentiallyDampedCosineModel([ell], [1.0], 1 / (2 * math.pi)).computeAsScalar([d]) for ell, d in ((ell_x, x), (ell_y, y))]
    return damped[0] * damped[1]


def turned(x, y, dip_deg):
    a = math.radians(dip_deg)
    return x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a)


FAMILIES = ("exponential", "exponential_isotropic", "squared_exponential", "matern_3_2", "matern_5_2", "cosine_exponential")
LAGS = ((0.0, 0.0), (0.3, 0.0), (0.0, 0.3), (0.8, -0.5), (-1.7, 0.4), (2.5, 1.1))


def correlations():
    """family, ell, dip, lag -> rho by either package; empty where GSTools has no such model."""
    for family in FAMILIES:
        for ell_x, ell_y, dip in ((1.3, 0.4, 0.0), (2.0, 0.5, 30.0)):
            for x, y in LAGS:
                model = gstools_model(family, ell_x, ell_y, dip)
                by_gstools = "" if model is None else repr(float(model.cov_spatial(np.array([[x], [y]]))[0]))
                yield [family, ell_x, ell_y, dip, x, y, by_gstools, repr(openturns_correlation(family, ell_x, ell_y, *turned(x, y, dip)))]


DATA = ((0.5, 2.5, 1.2, 0.0), (2.0, 3.0, -0.7, 0.3), (2.2, 3.1, -0.2, 0.3), (4.5, 4.0, 0.4, 0.1), (5.5, 2.2, -1.5, 0.2))  # x, y, value, standard error
POINTS = ((0.5, 2.5), (0.9, 2.6), (2.1, 3.05), (3.3, 3.4), (4.5, 4.1), (5.9, 4.9), (1.2, 4.4))


def kriging():
    """family, ell, dip, nugget, point -> mean and variance of simple kriging; the nugget is noise of every datum, and is not in the variance."""
    x, y, value, error = (np.array(column) for column in zip(*DATA))
    for family in ("exponential_isotropic", "squared_exponential", "matern_3_2", "matern_5_2"):
        for ell_x, ell_y, dip, nugget in ((1.5, 0.6, 0.0, 0.0), (2.0, 0.5, 30.0, 0.2)):
            model = gstools_model(family, ell_x, ell_y, dip, 1.0 - nugget)
            krige = gs.krige.Simple(model, (x, y), value, mean=0.0, cond_err=error**2 + nugget, exact=False)
            mean, variance = krige(tuple(np.array(column) for column in zip(*POINTS)))
            for point, m, v in zip(POINTS, mean, variance):
                yield [family, ell_x, ell_y, dip, nugget, *point, repr(float(m)), repr(float(v))]


def shares():
    """Eigenvalues over the area of [0, 6] x [0, 2] by finite elements (P1, 45 x 15 cells)."""
    mesh = ot.IntervalMesher([45, 15]).build(ot.Interval([0.0, 0.0], [6.0, 2.0]))
    for family in ("exponential_isotropic", "squared_exponential", "matern_3_2", "matern_5_2"):
        model = {"exponential_isotropic": ot.ExponentialModel([2.0, 0.7], [1.0]),
                 "squared_exponential": ot.SquaredExponential([2.0 / math.sqrt(2), 0.7 / math.sqrt(2)], [1.0]),
                 "matern_3_2": ot.MaternModel([2.0, 0.7], [1.0], 1.5), "matern_5_2": ot.MaternModel([2.0, 0.7], [1.0], 2.5)}[family]
        algorithm = ot.KarhunenLoeveP1Algorithm(mesh, model, 1e-3)
        algorithm.setNbModes(12)
        algorithm.run()
        for k, value in enumerate(list(algorithm.getResult().getEigenvalues())[:12]):
            yield [family, k, repr(value / 12.0)]


def write(name, columns, rows):
    with open(HERE / name, "w", newline="") as file:
        file.write(VERSIONS + "\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        writer.writerows(rows)


write("correlations.csv", ["family", "ell_x", "ell_y", "dip_deg", "dx", "dy", "gstools", "openturns"], correlations())
write("kriging.csv", ["family", "ell_x", "ell_y", "dip_deg", "nugget", "x", "y", "mean", "variance"], kriging())
write("shares.csv", ["family", "mode", "share"], shares())
