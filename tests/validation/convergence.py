"""The illustrative slope at its median friction angle: fronts as the spacing shrinks."""

import figures as fig
import numerics_budget as budget
import talus_runs
from experiment import at_most, table

TITLE = "Convergence of the illustrative slope"
SOURCE = "self-convergence; [Z20] section 4 has about 34.1 m at 0.1 m for soil whose viscosity it does not state, so agreement with the paper is no evidence"
REMARKS = ("With the viscosity that the case states, the front at fixed thickness and that of 99 % of the mass move by at most 0.1 m from 0.2 to 0.05 m, the centre of mass by 0.11 m. The farthest particle "
           "ends in a single row, which no spacing resolves: it moves by 0.2 m without a trend. The fastest particle of the deposit is slow, but no slower at finer spacings.")
NOT_MET = {"centre of mass: change at the last halving": 0.85}  # 0.1 to 0.05 m: 0.76
MEASURES = {"front_at_thickness_m": "front at fixed thickness", "front_mass_99_m": "99 % of the mass", "front_mass_999_m": "99.9 % of the mass", "front_connected_m": "connected body",
            "influence_zone_m": "farthest particle", "centre_of_mass_x_m": "centre of mass"}
RESOLVED = ("front_at_thickness_m", "front_mass_99_m")
LIMITS = {"centre_of_mass_x_m": (0.5, "a centre of many particles"), **{key: (2.0, "the spacing before it") for key in RESOLVED}}  # of the last halving, in finer spacings


def measure(work, coarse):
    rows = []
    for spacing in (0.4, 0.2) if coarse else (0.4, 0.2, 0.1, 0.05):
        result = run(work, spacing, coarse)
        rows.append({"spacing_m": spacing, "final_max_speed_m_s": result["final_max_speed_m_s"], "penetrated": result["penetrated"], "thickness_m": result["front_thickness_m"],
                     **{name: result[name] for name in MEASURES}})
    return {"rows": rows}


def run(work, spacing, coarse):
    """The runs of the numerical budget, which has them too."""
    slope = budget.cases(False)["slope"]
    varied = budget.NONE if spacing == slope.report else budget.Variation("spacing", f"{spacing:g} m")
    where = work / f"convergence-{spacing:g}" if coarse else budget.directory(work / "numerics_budget" / "slope", spacing, varied)
    return talus_runs.run(slope.case, where, {"particle_spacing_m": spacing, "terrain.front_thickness_m": budget.thickness(slope)}, threads=1)


def criteria(numbers):
    coarser, finest = numbers["rows"][-2:]
    found = []
    for key, name in MEASURES.items():
        spacings, why = LIMITS.get(key, (6.0, "the toe thinner than two rows"))
        found.append(at_most(f"{name}: change at the last halving, in finer spacings", abs(finest[key] - coarser[key]) / finest["spacing_m"], spacings, why))
    at_0_2 = next(row for row in numbers["rows"] if row["spacing_m"] == 0.2)
    if finest is not at_0_2:
        found += [at_most(f"{MEASURES[key]}: change from 0.2 m to the finest spacing [m]", abs(finest[key] - at_0_2[key]), 0.1) for key in RESOLVED]
    fall = 12.2
    return found + [at_most("fastest particle of the deposit over sqrt(g H)", finest["final_max_speed_m_s"] / (9.81 * fall) ** 0.5, 0.01),
                    at_most("particles behind a wall", sum(r["penetrated"] for r in numbers["rows"]), 0)]


def changes(rows, key):
    return ", ".join(f"{abs(b[key] - a[key]):.2f}" for a, b in zip(rows, rows[1:]))


def section(numbers, directory):
    figure, axes = fig.plt.subplots(figsize=(5, 3.2))
    for key, name in MEASURES.items():
        if key != "centre_of_mass_x_m":
            axes.semilogx([r["spacing_m"] for r in numbers["rows"]], [r[key] for r in numbers["rows"]], "o-", label=name)
    axes.set(xlabel="particle spacing dx [m]", ylabel="front [m]", xticks=[0.05, 0.1, 0.2, 0.4], xticklabels=["0.05", "0.1", "0.2", "0.4"])
    axes.minorticks_off()
    axes.legend(fontsize=7, ncol=2, loc="center", bbox_to_anchor=(0.5, 0.33))
    rows = [[r["spacing_m"], *(f"{r[key]:.3f}" for key in MEASURES), f"{1000 * r['final_max_speed_m_s']:.1f}"] for r in numbers["rows"]]
    return table(["dx [m]", *(f"{name} [m]" for name in MEASURES.values()), "fastest particle at the end [mm/s]"], rows) + \
        f"\nThe fixed thickness is {numbers['rows'][0]['thickness_m']:.2g} m. Changes at each halving [m]: " + "; ".join(f"{name} {changes(numbers['rows'], key)}" for key, name in MEASURES.items()) + ".\n\n" + fig.save(figure, directory, "convergence")
