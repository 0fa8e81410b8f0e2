"""One chatter sequence, from impact to contact and release: the gap, and the normal speed of the impacts."""
import numpy as np

from registry import picture

from . import style

ETA, AFTER = 0.2, 20.0  # drag speed; time after which a sequence that ends in contact is looked for [tau]
BEFORE, BEHIND = 0.5, 0.3  # of the window, before the sequence and after the release [tau]
SAMPLES = 60000
LEAST_GAP = 1e-8  # drawn [a]


def find_sequence(tip):
    """Times of its begin, of the contact and of the release, and how many bounces it stands for."""
    import afm  # the other pictures do without
    events = tip.copy().advance(AFTER + 30.0)
    times, kinds = events["tau"] + events["phase"], events["kind"]
    i = next(i for i in range(2, len(events)) if times[i] > AFTER + 2.0 and kinds[i] == afm.Kind.CONTACT_BEGUN
             and kinds[i - 1] == afm.Kind.BURST)
    return times[i - 2], times[i], times[i + 1], events["count"][i - 1]


def impacts(events, kind):
    chosen = events[(events["kind"] == kind) & (events["normal_speed"] > 0)]
    return chosen["tau"] + chosen["phase"], chosen["normal_speed"]


@picture()
def chatter_sequence(_):
    import afm
    tip = afm.Tip(eta=ETA)
    tip.advance(AFTER)
    begin, contact, release, bounces = find_sequence(tip)
    start, period = begin - BEFORE, (BEFORE + release + BEHIND - begin) / SAMPLES
    tip.advance(start)
    state = tip.state
    one_by_one = afm.Tip(eta=ETA, phase=state.phase, extension=state.extension, y=state.y, u=state.u, w=state.w,
                         contact_tolerance=0.0)
    every = one_by_one.advance(contact - start)
    path = tip.samples(period, SAMPLES)
    times = path.times
    x = state.phase + ETA * (times - times[0]) + path.lateral - state.extension
    gap = path.vertical - style.AMPLITUDE * np.cos(style.TWO_PI * x)

    figure, (top, bottom) = style.new(5.8, 2, 1, sharex=True)
    shown = np.where(gap > LEAST_GAP, gap, np.nan)
    shown[(times > begin) & (times < release)] = np.nan
    top.semilogy(times, shown, color=style.BLUE, linewidth=1.0)
    top.set(ylim=(LEAST_GAP, 1), ylabel="gap between tip and surface [a]")
    at, speed = impacts(every, afm.Kind.IMPACT)
    bottom.semilogy(at + start, speed, color=style.ORANGE, linewidth=1.4, label="every bounce computed by itself")
    at, speed = impacts(path.events, afm.Kind.IMPACT)
    bottom.semilogy(at, speed, "o", color=style.BLUE, markersize=4.5, label="impacts of the emulator", **style.OPEN)
    bottom.set(ylabel=r"normal speed of impacts [$a/\tau$]", xlabel=r"model time [$\tau$]")
    for axes in (top, bottom):
        axes.axvspan(begin, contact, color=style.ORANGE, alpha=0.15, linewidth=0)
        axes.axvspan(contact, release, color=style.GREEN, alpha=0.15, linewidth=0)
        axes.set_xlim(start, release + BEHIND)
    for low, high, text in ((start, begin, "impacts,\none by one"),
                            (begin, contact, "chatter sequence:\nthe averaged law replaces\n%d bounces" % bounces),
                            (contact, release, "contact:\nthe tip slides without friction"),
                            (release, release + BEHIND, "release\nand flight")):
        top.text(0.5 * (low + high), 0.2, text, ha="center", va="top", fontsize=style.SMALL)
    style.legend_above(bottom)
    return figure
