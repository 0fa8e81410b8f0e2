"""Cost against work: impacts, tips, threads."""
from registry import picture

from . import style


def column(rows, axis, name):
    return [float(row[name]) for row in rows if row["axis"] == axis]


def draw_time(axes, rows):
    n, seconds = column(rows, "impacts", "n"), column(rows, "impacts", "seconds")
    middle = len(n) // 2
    axes.loglog(n, [seconds[middle] * k / n[middle] for k in n], "--", color=style.GREY, linewidth=1.2,
                label="in proportion")
    axes.loglog(n, seconds, "o", color=style.BLUE, markersize=6, label="one tip")
    axes.loglog([100 * k for k in column(rows, "tips", "n")], column(rows, "tips", "seconds"), "s", color=style.ORANGE,
                markersize=11, markerfacecolor="none", markeredgewidth=1.4, label="many tips, 100 impacts each")
    axes.set(xlabel="impacts in all", ylabel="processor time [s]")


def draw_threads(axes, rows):
    n, wall = column(rows, "threads", "n"), column(rows, "threads", "seconds")
    each = column(rows, "threads", "ns_per_impact")
    axes.plot(n, [value / each[0] for value in each], "o-", color=style.BLUE, markersize=6,
              label="processor time per impact")
    axes.plot(n, [value / wall[0] for value in wall], "s--", color=style.ORANGE, markersize=6, label="wall time",
              **style.OPEN)
    axes.set_ylim(bottom=0)
    axes.set_xticks(n)
    axes.set(xlabel="threads (2 processors)", ylabel="ratio to one thread")


def draw_memory(axes, rows):
    n, held = column(rows, "tips", "n"), column(rows, "tips", "resident_bytes")
    shown = [(k, b) for k, b in zip(n, held) if b > 0 and k >= 100]
    k0, b0 = shown[-1]
    axes.loglog([k for k, _ in shown], [b0 / 1e6 * k / k0 for k, _ in shown], "--", color=style.GREY, linewidth=1.2,
                label="in proportion")
    axes.loglog([k for k, _ in shown], [b / 1e6 for _, b in shown], "o", color=style.BLUE, markersize=6, label="measured")
    axes.set(xlabel="tips", ylabel="memory [MB]")


@picture("work_cost", name="work_cost")
def draw(tables):
    rows = tables.strings("work_cost")
    figure, axes = style.new(3.6, 1, 3)
    draw_time(axes[0], rows)
    draw_memory(axes[1], rows)
    draw_threads(axes[2], rows)
    for one in axes:
        style.legend_above(one, columns=1)
    return figure
