"""The study of Zhang et al. 2020, Table 4: cases 1-9, each with three truncations of the random field.

`python3 paper_study.py WORK [N ...]` brings all of them to N realizations each, in as many passes as there are Ns; stopped at any moment,
the same command goes on. What is done is kept in books/, a directory of tables for each study, which any machine can go on from.
"""

import csv
import json
import pathlib
import shutil
import sys

import numpy as np

import figures as fig
import talus_runs
from experiment import Criterion, at_most, table

TITLE = "The paper's study"
SOURCE = "[Z20] section 4, Table 4 and Figures 12-15: |sigma| = 0.0763 ... 0.3814 at ell = 0.5 m (cases 1-5), ell = 0.1 ... 0.4 m at |sigma| = 0.2289 (cases 6-9, 3)"
NOT_MET = ["share: spread at ell"]  # at the coarse spacing of 0.8 m, which does not resolve ell = 0.1 ... 0.5 m
WANTED = 100  # realizations of each study
SPACING = 0.2
TABLE_4 = {  # standard deviation of ln tan(phi), correlation length [m]
    1: (0.0763, 0.5), 2: (0.1526, 0.5), 3: (0.2289, 0.5), 4: (0.3052, 0.5), 5: (0.3814, 0.5),
    6: (0.2289, 0.1), 7: (0.2289, 0.2), 8: (0.2289, 0.3), 9: (0.2289, 0.4),
}
TRUNCATIONS = {
    "sorted": {"random_field.truncation": "largest", "random_field.terms": 5},
    "share": {"random_field.truncation": "variance_share", "random_field.variance_share": 0.95},
    "diagonal": {"random_field.truncation": "diagonal", "random_field.terms": 5},
}


def settings(case, truncation, spacing=SPACING):
    """Run until the slide rests: the rule ends a run some 0.2 s after the front has stopped."""
    stdev, length = TABLE_4[case]
    return {"particle_spacing_m": spacing, "random_field.log_stdev": stdev, "random_field.correlation_length_m": length,
            "time.end_s": 15, "time.stop_at_rest": True, **TRUNCATIONS[truncation]}


def name(case, truncation):
    return f"case{case}-{truncation}"


BOOKS = pathlib.Path(__file__).resolve().parent / "books"
TABLES = ("plan.json", "case.resolved.json", "noise_floor.csv", "realizations.csv")  # what `talus stats` reads; the last one counts what is done


def read_rows(book):
    """Rows of its realizations.csv; none where there is no book yet."""
    if not (book / "realizations.csv").exists():
        return []
    with open(book / "realizations.csv", newline="") as file:
        return list(csv.DictReader(file))


def advance(work, realizations, spacing=SPACING, books=BOOKS):
    """Every study to at least so many realizations. Realization i has the same draws in all cases."""
    for truncation in TRUNCATIONS:
        for case in TABLE_4:
            extend(pathlib.Path(work) / "paper_study" / f"dx{spacing:g}", books / name(case, truncation), realizations, settings(case, truncation, spacing))
            print(name(case, truncation), realizations, flush=True)


def extend(work, book, realizations, chosen):
    """Runs what the book lacks, and enters it."""
    rows = read_rows(book)
    if len(rows) >= realizations:
        return
    if [int(row["index"]) for row in rows] != list(range(len(rows))):
        raise SystemExit(f"{book} has gaps")
    if rows:
        check_program(work, rows[0], chosen)
    part, joined = work / f"{book.name}-from-{len(rows)}", work / f"{book.name}-joined"
    talus_runs.study(talus_runs.CASES / "illustrative.json", part, realizations, chosen, first=len(rows))
    shutil.rmtree(joined, ignore_errors=True)
    talus_runs.call(["stats", *([book] if rows else []), part, "--out", joined])
    enter(joined, book)
    shutil.rmtree(part), shutil.rmtree(joined)


def enter(study, book):
    """Copies a study's tables; killed in between, it can be done again."""
    book.mkdir(parents=True, exist_ok=True)
    for table_name in TABLES:
        shutil.copy(study / table_name, book / (table_name + ".new"))
        (book / (table_name + ".new")).rename(book / table_name)


def check_program(work, row, chosen):
    """Runs one realization of the book again: a program that gives other bits must not go on with it."""
    where = work / "again"
    shutil.rmtree(where, ignore_errors=True)
    found = talus_runs.run(talus_runs.CASES / "illustrative.json", where, chosen, threads=1, extra=["--realization", row["index"], "--seed", 1])["digest"]
    if found != row["digest"]:
        raise SystemExit(f"realization {row['index']} has the digest {found} now, {row['digest']} in the books: start new ones")


def measure(work, coarse):
    """Reads what `advance` has entered in the books; coarse ones are made here."""
    spacing, books = (0.8, pathlib.Path(work) / "books") if coarse else (SPACING, BOOKS)
    if coarse:
        advance(work, 20, spacing, books)
    studies = []
    for truncation in TRUNCATIONS:
        for case in TABLE_4:
            book = books / name(case, truncation)
            if book.exists():
                counted = pathlib.Path(work) / "paper_study" / f"{book.name}-counted"
                shutil.rmtree(counted, ignore_errors=True)
                talus_runs.call(["stats", book, "--out", counted])
                studies.append(summary(case, truncation, counted))
    return {"spacing_m": spacing, "studies": studies}


def summary(case, truncation, where):
    study = json.loads((where / "study.json").read_text())
    found = {"case": case, "truncation": truncation, "captured": study["captured_variance"]}
    for key in ("influence_zone_m", "front_connected_m", "front_mass_99_m", "centre_of_mass_x_m"):
        quantity = study["quantities"][key]
        found[key] = {name: quantity[name] for name in ("mean", "mean_ci95", "stdev", "stdev_ci95", "noise_floor_stdev")}
    rows = [row for row in read_rows(where) if row["status"] == "done"]
    found["n"] = len(rows)
    found["fronts"] = [round(float(row["influence_zone_m"]), 3) for row in rows]
    phi = np.array([float(row["mean_friction_angle_deg"]) for row in rows])
    found["front_by_angle"] = float(np.polyfit(phi, found["fronts"], 1)[0]) if phi.std() > 1e-6 else 0.0  # [m/deg]
    found["correlation_with_angle"] = float(np.corrcoef(phi, found["fronts"])[0, 1]) if phi.std() > 1e-6 else 0.0
    return found


def of(numbers, case, truncation):
    return next((s for s in numbers["studies"] if s["case"] == case and s["truncation"] == truncation), None)


def series(numbers, truncation, cases):
    return [s for s in (of(numbers, case, truncation) for case in cases) if s]


def criteria(numbers):
    found = []
    for truncation in TRUNCATIONS:
        by_sigma = series(numbers, truncation, (1, 2, 3, 4, 5))
        if len(by_sigma) == 5:
            ratio = by_sigma[0]["influence_zone_m"]["stdev"] / by_sigma[-1]["influence_zone_m"]["stdev"]
            found.append(at_most(f"{truncation}: spread of case 1 over case 5", ratio, 0.6))
        by_length = series(numbers, truncation, (6, 3))
        if len(by_length) == 2:
            found.append(at_most(f"{truncation}: spread at ell = 0.1 over 0.5 m",
                                 by_length[0]["influence_zone_m"]["stdev"] / by_length[1]["influence_zone_m"]["stdev"], 0.8))
    floors = [s["influence_zone_m"]["noise_floor_stdev"] / s["influence_zone_m"]["stdev"] for s in numbers["studies"]]
    return found + ([at_most("largest noise floor over a study's spread", max(floors), 0.5)] if floors else [])


def interval(values, digits=3):
    return f"{values[0]:.{digits}f} to {values[1]:.{digits}f}"


def section(numbers, directory):
    rows = []
    for s in numbers["studies"]:
        sigma, length = TABLE_4[s["case"]]
        zone = s["influence_zone_m"]
        rows.append([s["case"], s["truncation"], sigma, length, s["n"], f"{100 * s['captured']:.1f}", f"{zone['mean']:.3f}", interval(zone["mean_ci95"]),
                     f"{zone['stdev']:.3f}", interval(zone["stdev_ci95"]), f"{1000 * zone['noise_floor_stdev']:.1f}", f"{s['centre_of_mass_x_m']['stdev']:.3f}"])
    text = f"Spacing {numbers['spacing_m']:g} m, default numerics; realization i has the same draws in every case. `sorted`: the 5 largest modes; `diagonal`: " \
           "5 pairs of equal index; `share`: 95 % of the variance.\n\n"
    fewest = min(s["n"] for s in numbers["studies"])
    if fewest < WANTED:
        text += f"Of the {WANTED} realizations wanted of each study at least {fewest} are done; the intervals say what that leaves open.\n\n"
    text += table(["case", "modes", "sigma", "ell [m]", "N", "captured [%]", "mean [m]", "95 %", "stdev [m]", "95 %", "floor [mm]", "stdev of the centre of mass [m]"], rows)
    return text + "\n" + draw(numbers, directory) + "\n" + conclusions(numbers)


def draw(numbers, directory):
    figure, (left, right) = fig.plt.subplots(1, 2, figsize=(7.5, 3.2))
    for truncation in TRUNCATIONS:
        for axes, cases, parameter in ((left, (1, 2, 3, 4, 5), 0), (right, (6, 7, 8, 9, 3), 1)):
            found = series(numbers, truncation, cases)
            if not found:
                continue
            spread = np.array([s["influence_zone_m"]["stdev"] for s in found])
            low, high = np.array([s["influence_zone_m"]["stdev_ci95"] for s in found]).T
            axes.errorbar([TABLE_4[s["case"]][parameter] for s in found], spread, [spread - low, high - spread], fmt="o-", capsize=2, label=truncation)
    left.set(xlabel="sigma of ln tan(phi)", ylabel="stdev of the influence zone [m]", ylim=(0, None))
    right.set(xlabel="ell [m]", ylim=(0, None))
    left.legend()
    figure.tight_layout()
    text = fig.save(figure, directory, "paper_study_spread")
    figure, axes = fig.plt.subplots(1, 3, figsize=(9, 2.6), sharex=True, sharey=True)
    for panel, truncation in zip(axes, TRUNCATIONS):
        for case in (1, 3, 5):
            if s := of(numbers, case, truncation):
                panel.hist(s["fronts"], bins=np.arange(min(s["fronts"]) - 0.25, max(s["fronts"]) + 0.5, 0.25), histtype="step", density=True, label=f"case {case}")
        panel.set(title=truncation, xlabel="influence zone [m]")
    axes[0].legend()
    figure.tight_layout()
    return text + "\n" + fig.save(figure, directory, "paper_study_histograms")


def ratio(of_studies):
    """Ratio of the second study's spread to the first's, with its 95 % interval; that of log s has the variance 1/(2 (n - 1))."""
    first, second = (s["influence_zone_m"]["stdev"] for s in of_studies)
    half = 1.96 * np.sqrt(sum(0.5 / (s["n"] - 1) for s in of_studies))
    return second / first, second / first * np.exp(-half), second / first * np.exp(half)


def correlation(study):
    """Of the influence zone with the mean friction angle, with its 95 % interval by Fisher's z."""
    r, half = study["correlation_with_angle"], 1.96 / np.sqrt(max(study["n"] - 3, 1))
    return r, np.tanh(np.arctanh(r) - half), np.tanh(np.arctanh(r) + half)


def said(found, digits=2):
    value, low, high = found
    return f"{value:.{digits}f} ({low:.{digits}f} to {high:.{digits}f})"


def listed(studies, value):
    return ", ".join(value(s) for s in studies)


def spreads(studies):
    return listed(studies, lambda s: f"{s['influence_zone_m']['stdev']:.3f}")


def share_captured(studies):
    return listed(studies, lambda s: f"{100 * s['captured']:.1f}")


def conclusions(numbers):
    """The paper's four conclusions (its section 5), each with the numbers that decide. Intervals are of 95 %."""
    lines = ["### The paper's conclusions", ""]
    by_sigma = {t: series(numbers, t, (1, 2, 3, 4, 5)) for t in TRUNCATIONS}
    by_length = {t: series(numbers, t, (6, 7, 8, 9, 3)) for t in TRUNCATIONS}
    complete = [t for t in TRUNCATIONS if len(by_sigma[t]) == 5 and len(by_length[t]) == 5]
    if "sorted" not in complete or "share" not in complete:
        return "\n".join(lines + ["Not all of the nine cases have run yet."]) + "\n"
    return "\n".join(lines + [first_conclusion(by_length, complete), second_conclusion(by_sigma, complete), third_conclusion(by_sigma, complete),
                              fourth_conclusion(by_length, complete)]) + "\n"


def first_conclusion(by_length, complete):
    found = "; ".join(f"`{t}` {share_captured(by_length[t])} %" for t in complete)
    return f"1. *The expansion gives a reasonable random field.* With five modes it does not: at ell = 0.1 ... 0.5 m the share of the variance that the field has is {found}."


def second_conclusion(by_sigma, complete):
    case_3 = {t: by_sigma[t][2] for t in complete}
    confirmed = all(correlation(s)[2] < 0 for s in case_3.values())
    found = "; ".join(f"`{t}` {said(correlation(s))}, {s['front_by_angle']:.2f} m per degree" for t, s in case_3.items())
    return (f"2. *A larger friction angle shortens the run-out.* {'Confirmed' if confirmed else 'Not confirmed for all truncations'}: "
            f"correlation of the influence zone with the mean angle in case 3: {found}.")


def third_conclusion(by_sigma, complete):
    grows = {t: ratio((by_sigma[t][0], by_sigma[t][4])) for t in complete}
    confirmed = all(low > 1 for _, low, _ in grows.values())
    found = "; ".join(f"`{t}` {spreads(by_sigma[t])} m, {said(r, 1)} times from case 1 to 5 ({'in' if r[1] <= 5 <= r[2] else 'not in'} proportion to sigma, which is 5)"
                      for t, r in grows.items())
    floor = max(s["influence_zone_m"]["noise_floor_stdev"] / s["influence_zone_m"]["stdev"] for t in complete for s in by_sigma[t])
    return (f"3. *The spread grows with the coefficient of variation.* {'Confirmed' if confirmed else 'Not confirmed'}: {found}. "
            f"The numerical noise is at most {100 * floor:.1f} % of a spread.")


def fourth_conclusion(by_length, complete):
    grows = {t: ratio((by_length[t][0], by_length[t][4])) for t in complete}
    artefact = grows["sorted"][1] > 1 and grows["share"][2] < grows["sorted"][1]
    verdict = ("An artefact of truncation" if artefact and grows["share"][1] <= 1 else "Mostly an artefact of truncation" if artefact else
               "Confirmed" if all(low > 1 for _, low, _ in grows.values()) else "Not decided")
    found = "; ".join(f"`{t}` {spreads(by_length[t])} m at ell = 0.1 ... 0.5 m, {said(r)} times" for t, r in grows.items())
    return (f"4. *Too small a correlation length underestimates the spread (which widens above ell/dx = 3).* {verdict}: {found}. With five modes the share of the "
            f"variance grows with ell, and the spread with it; square root of its growth: {np.sqrt(by_length['sorted'][4]['captured'] / by_length['sorted'][0]['captured']):.2f} (`sorted`).")


if __name__ == "__main__":
    for target in sys.argv[2:] or [WANTED]:
        advance(sys.argv[1], int(target))
