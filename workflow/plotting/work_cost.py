"""Cost against work: impacts, tips, threads."""
from registry import picture

from . import style

OURS, LINE = "#D55E00", "#0072B2"


def column(rows, axis, name):
    return [float(row[name]) for row in rows if row["axis"] == axis]


def draw_time(axes, rows, axis, label):
    n, seconds = column(rows, axis, "n"), column(rows, axis, "seconds")
    axes.loglog(n, seconds, "o", color=OURS, markersize=9)
    # the straight line through the middle point
    middle = len(n) // 2
    axes.loglog(n, [seconds[middle] * k / n[middle] for k in n], "--", color=LINE, linewidth=1.4)
    axes.set_xlabel(label)
    axes.set_ylabel("processor time / s")


def draw_threads(axes, rows):
    n, wall = column(rows, "threads", "n"), column(rows, "threads", "seconds")
    each = column(rows, "threads", "ns_per_impact")
    axes.plot(n, [value / each[0] for value in each], "o-", color=OURS, markersize=9, label="processor time per impact")
    axes.plot(n, [value / wall[0] for value in wall], "s--", color=LINE, markersize=8, label="wall time")
    axes.set_ylim(bottom=0)
    axes.set_xticks(n)
    axes.set_xlabel("threads, the same work each")
    axes.set_ylabel("against one thread")
    axes.legend(fontsize=11, loc="lower right")


def draw_memory(axes, rows):
    n, held = column(rows, "tips", "n"), column(rows, "tips", "resident_bytes")
    shown = [(k, b) for k, b in zip(n, held) if b > 0 and k >= 100]
    axes.loglog([k for k, _ in shown], [b / 1e6 for _, b in shown], "o", color=OURS, markersize=9)
    k0, b0 = shown[-1]
    axes.loglog([k for k, _ in shown], [b0 / 1e6 * k / k0 for k, _ in shown], "--", color=LINE, linewidth=1.4)
    axes.set_xlabel("tips")
    axes.set_ylabel("memory / MB")


@picture("work_cost", name="work_cost")
def draw(tables):
    rows = tables.strings("work_cost")
    figure, axes = style.new(8.4, 6.6, 2, 2)
    draw_time(axes[0][0], rows, "impacts", "impacts of one tip")
    draw_time(axes[0][1], rows, "tips", "tips, 100 impacts each")
    draw_threads(axes[1][0], rows)
    draw_memory(axes[1][1], rows)
    figure.suptitle("Cost against work (dashed: straight lines)", fontsize=14)
    for one in axes.flat:
        one.grid(which="major", color="#dddddd", linewidth=0.8)
    return figure
