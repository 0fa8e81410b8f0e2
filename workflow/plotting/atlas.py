"""Which attractor a random start finds, over drag velocity and restitution."""
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

from registry import picture

from . import style

KINDS = [("period 1", "#004D80"), ("period 2", style.BLUE), ("period 3 or 4", style.SKY),
         ("longer period", "#B5DDF5"), ("quasi-periodic", style.GREEN), ("chaotic", style.ORANGE),
         ("contact", style.YELLOW), ("undecided", "#000000")]


def kind(row):
    name = row["attractor"]
    if name.startswith("period-"):
        n = int(name[len("period-"):])
        return 0 if n <= 1 else 1 if n == 2 else 2 if n <= 4 else 3
    return {"quasi-periodic": 4, "chaotic": 5, "contact": 6}.get(name, 7)


def image_of(rows, value):
    etas, gammas = sorted({row["eta"] for row in rows}), sorted({row["gamma"] for row in rows})
    column, line = {v: i for i, v in enumerate(etas)}, {v: i for i, v in enumerate(gammas)}
    image = [[float("nan")] * len(etas) for _ in gammas]
    for row in rows:
        image[line[row["gamma"]]][column[row["eta"]]] = value(row)
    half = 0.5 * (etas[1] - etas[0]), 0.5 * (gammas[1] - gammas[0])
    return image, (etas[0] - half[0], etas[-1] + half[0], gammas[0] - half[1], gammas[-1] + half[1])


@picture("atlas")
def fig7_atlas(tables):
    rows = tables.rows("atlas")
    figure, axes = style.new(7.4, 2, 1, sharex=True)
    image, extent = image_of(rows, kind)
    colours = ListedColormap([colour for _, colour in KINDS])
    axes[0].imshow(image, extent=extent, origin="lower", aspect="auto", cmap=colours, interpolation="nearest",
                   norm=BoundaryNorm([i - 0.5 for i in range(len(KINDS) + 1)], len(KINDS)))
    axes[0].set_title("attractor that a random start finds", loc="left")
    style.legend_of_all(figure, {name: Patch(facecolor=colour) for name, colour in KINDS}, 8, columnspacing=1.0,
                        handlelength=1.1)
    image, extent = image_of(rows, lambda row: row["k_f"] / style.closed_form(row["gamma"]))
    drawn = axes[1].imshow(image, extent=extent, origin="lower", aspect="auto", cmap="cividis", interpolation="nearest",
                           vmin=0, vmax=1)
    figure.colorbar(drawn, ax=axes[1], orientation="horizontal", aspect=50, pad=0.02, extend="max",
                    label=r"$K_f$ over the closed form at even $\eta$ for the same $\gamma$")
    axes[1].set_xlabel(style.ETA_LABEL)
    for ax in axes:
        ax.set_ylabel(r"restitution $\gamma$")
        ax.grid(False)
    axes[0].tick_params(labelbottom=True)
    return figure
