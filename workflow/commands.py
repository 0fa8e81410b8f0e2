"""Every command that is measured: the name of its table, what runs, and the tables that it writes besides."""
import math
import re
from collections import namedtuple
from pathlib import Path

# may_fail: a failure is a result too
ROOT = Path(__file__).resolve().parent.parent
Command = namedtuple("Command", "words sides may_fail")

KELVIN = 0.926 / 300.0  # kT of mica's tip [m_tip a^2/tau^2] for each kelvin; docs/temperature.md
TEMPERATURES = (0, 4, 77, 300)  # [K]
QUALITIES = (500, 100, 20)
THERMAL_FINE = (2, 4, 6, 8)  # eta of the peaks
BATHS = [(0, 0)] + [(kelvin, quality) for quality in QUALITIES for kelvin in TEMPERATURES]  # (0, 0): none
GOLDEN = (2.618, 4.236, 6.854, 11.09, 17.944, 29.034, 46.979, 76.013)  # kicks per tau: powers of the golden ratio
REFERENCE_KICKS = 122.99
# omega_h/omega_v of the levers in config/levers with their rate of kicks; and 22, of which 11.09 is half
LEVER_KICKS = {2: 11.09, 14: 8.652, 17: 10.507, 21: 12.979, 30: 18.541, 22: 11.09}
MORE_KICKS = (29.034, REFERENCE_KICKS)
# where a rate of kicks locks to the lateral spring: 11.09 at omega_h/omega_v = 11.1, and 29.034 at 14; at 12.5 only
# with a low Q
LOCK_RATIOS, LOCK_QUALITIES, LOCK_KICKS = (11.1, 12.5, 14), (20, 100), (8.652, 11.09, 29.034, 46.979, REFERENCE_KICKS)
# in liquids: suitable_kicks() by omega_h/omega_v and Q, beside the default and nearly the most that can be given
LIQUID_KICKS = {(6.25, 1): 357.618, (6.25, 2): 179.618, (6.25, 5): 122.99, (20, 2): 572.618, (20, 5): 229.618,
                (20, 10): 122.99, (20, 20): 122.99, (41, 5): 469.618, (41, 10): 235.618, (41, 20): 122.99}
LIQUID_MORE = (29.034, 843.618)
# coexisting attractors. eta: (K_f of the two without heat, window [tau], kT [m_tip a^2/tau^2])
HOPS = {2: ((5.489, 5.646), 20, (0.0003, 0.0005, 0.0007, 0.001, 0.0014, 0.002)),
        6.5: ((0.4397, 0.5056), 50, (0.02, 0.025, 0.03, 0.04, 0.05, 0.065, 0.08, 0.1, 0.12))}
HOPS_QUALITY, TRACES = 500, (0.025, 0.08, 0.2377, 0.926)
MERGE_ETAS, MERGE_QUALITIES = (2, 3.75, 6.5), (500, 100)
WINDOWS = ((1.9, 2.15), (3.6, 3.9), (6.2, 6.7))  # of eta, where attractors coexist
LOAD_ETAS = (0.5, 1.51, 2, 3.4)
LEVERS, CRYSTALS = ("paper", "ppp_cont", "csc37_b"), ("mica", "nacl", "hopg")  # of the picture friction against load
LEVER_SPEED, MOST_LOAD = 5e-6, 0.2e-9  # [m/s], [N]
CUTOFF_SPEED = 1.66e-7  # [m/s]
HAMMER_ETA, HAMMER_ETAS = 3.2, (1.5, 2.0, 3.4)
# no even numbers, at which the horizontal spring is in resonance with the orbit of even eta
RATIOS = (2.25, 3.25, 4.25, 6.25, 8.25, 12.25, 17.25, 24.25, 34.25, 48.25, 68.25, 98.25, 140.25, 198.25)
BRANCHES = {"eta_2": ("eta", (1.5, 2.6), ("--eta 2 --vary eta --to 1.2", "--eta 2 --vary eta --to 3")),
            "eta_3": ("eta", (3.0, 4.3), ("--eta 4 --vary eta --to 3.0", "--eta 4 --vary eta --to 5.0")),
            "gamma_3": ("gamma", (0.3, 0.95),
                        ("--eta 3.4 --vary gamma --to 0.2", "--eta 3.4 --vary gamma --to 0.97",
                         "--eta 3.4 --vary gamma --to 0.97 --length 4"))}
FUZZED = ("csv_filter", "parameters", "bag_messages", "tip")


def values(path):
    """The numbers of a file of config/."""
    return {name: float(value) for name, value in re.findall(r"^(\w+): ([-+.\deE]+)", (ROOT / path).read_text(), re.M)}


def lever_scene(lever, crystal):
    """Options of friction_curve, in natural units, and the most load [a] that its rest heights reach."""
    spring, surface = values("config/levers/%s.yaml" % lever), values("config/surfaces/%s.yaml" % crystal)
    k, f0, a = spring["spring_constant_n_per_m"], spring["resonance_hz"], surface["lattice_spacing_m"]
    ratio = math.sqrt(spring["lateral_spring_constant_n_per_m"] / k)
    theta = 1.380649e-23 * 300.0 * (2.0 * math.pi) ** 2 / (k * a * a)  # kT in m_tip a^2/tau^2, with m = k / (2 pi f0)^2
    most = MOST_LOAD / (k * a)
    words = ("--eta %.9g --cutoff %.9g --amplitude %.9g --frequency-ratio %.9g --temperature %.9g --quality-factor 100"
             % (LEVER_SPEED / (a * f0), CUTOFF_SPEED / (a * f0), surface["surface_amplitude_m"] / a, ratio, theta))
    return words, most


def bath_name(kelvin, quality):
    return "%g_%g" % (kelvin, quality)


def kicks_name(eta, quality, theta, kicks):
    return "kicks_%g_%g_%g_%g" % (eta, quality, theta, kicks)


def windows_name(eta, theta, quality, window, duration):
    return "windows_%g_%g_%g_%g_%g" % (eta, quality, theta, window, duration)


def kicks_cases(quick):
    return [(eta, quality, theta) for quality in ((500, 20) if quick else QUALITIES) for theta in (0, 0.926)
            for eta in ((2,) if quick else (1, 2, 3.4, 5, 6))]


def commands(quick):
    """Those of quick runs or of full ones, by name. {out} stands for the folder of the tables."""
    all_commands = {}

    def choose(short, full):
        return short if quick else full

    def add(name, *words, sides=(), may_fail=False):
        text = " ".join(str(word) for word in words)
        all_commands[name] = Command(text, tuple(sides), may_fail)

    def curve(name, *words):
        add(name, "friction_curve", *words)

    # the paper's figures
    mica = ("--gamma 0.7 --cutoff 0.05",)
    for direction in ("up", "down"):
        curve("friction_curve_" + direction, *mica, "--eta", choose("0.02:9:0.1", "0.02:9:0.01"),
              "--duration 3000 --sweep", direction)
    for eta in (2, 2.5, 3.75, 6.5):
        add("coexisting_%g" % eta, "attractors --eta", eta, "--relative-cutoff --cutoff 0.1 --starts", choose(10, 100))
    for low, high in WINDOWS:
        add("coexistence_%g" % low, "attractors", *mica, "--eta", "%g:%g:%g"
            % (low, high, (high - low) / choose(10, 100)),
            "--starts", choose(10, 60), "--friction-duration 300")
        for direction in ("up", "down"):
            curve("sweep_%s_%g" % (direction, low), *mica, "--eta", "%g:%g:%g" % (low, high, choose(0.025, 0.0025)),
                  "--sweep", direction, "--duration 3000")
    add("periodic_orbits", "periodic_orbits --eta 3.4", *mica, choose("--max-length 6 --trajectory 20000 --guesses 200",
        "--max-length 10 --trajectory 1000000 --guesses 3000"), "--averages {out}/cycle_averages.csv --quiet",
        sides=["cycle_averages"])
    curve("direct", "--eta 3.4", *mica, "--duration", choose(20000, 1000000))
    add("even_orbit_gamma", "continue_orbits --cutoff 0.05 --eta 2 --gamma 0.7 --vary gamma --to 0.1")
    add("even_basins", "attractors --eta 2 --gamma", choose("0.2:0.8:0.1 --starts 20", "0.2:0.8:0.01 --starts 200"),
        "--cutoff 0.05 --friction-duration 200")
    for name, (_, _, branches) in BRANCHES.items():
        for i, branch in enumerate(branches):
            add("%s_branch_%d" % (name, i), "continue_orbits --cutoff 0.05", branch)
    add("atlas", "attractors --eta", choose("0.1:9:0.1 --gamma 0.3:0.95:0.05", "0.03:9:0.03 --gamma 0.3:0.95:0.01"),
        "--cutoff 0.05 --starts 1 --friction-duration 200")
    curve("scaling_eta", "--eta", choose("0.5:9:0.1 --duration 1000", "0.5:9:0.02 --duration 5000"), *mica)
    add("scaling_gamma", "continue_orbits --eta 4", *mica, "--vary gamma --to 0.9")

    # the hammer
    length = ("--duration", choose(200, 1000), "--transient 300")
    for model in ("oscillator", "hammer"):
        curve("hammer_curve_" + model, "--model", model, "--eta", choose("0.1:9:0.2", "0.1:9:0.05"), "--cutoff 0.05",
              *length)
    add("hammer_error_eta", "model_error --eta", choose("0.5:9:0.5", "0.1:9:0.1"),
        "--relative-cutoff --cutoff 0.05 --starts 2", *length)
    ratios = RATIOS[::3] if quick else RATIOS
    add("hammer_error_ratio", "model_error --eta", ",".join(map(str, HAMMER_ETAS)), "--frequency-ratio",
        ",".join(map(str, ratios)), "--relative-cutoff --cutoff 0.05 --starts 2", *length)
    add("hammer_words", "symbolic_dynamics --eta", HAMMER_ETA, choose("--max-length 8 --impacts 50000",
                                                                      "--max-length 14 --impacts 2000000"),
        "--section {out}/hammer_section.csv --forbidden {out}/hammer_forbidden.csv",
        sides=["hammer_section", "hammer_forbidden"])
    add("hammer_named", "symbolic_dynamics --eta", HAMMER_ETA, choose("--max-length 5 --guesses 200",
                                                                      "--max-length 8 --guesses 1500"),
        "--orbits {out}/hammer_orbits.csv", sides=["hammer_orbits"])
    add("hammer_orbits_10", "periodic_orbits --model hammer --eta", HAMMER_ETA, choose(
        "--max-length 6 --trajectory 20000 --guesses 200", "--max-length 10 --trajectory 200000 --guesses 3000"),
        "--averages {out}/hammer_cycles.csv --quiet", sides=["hammer_cycles"])
    curve("hammer_direct", "--model hammer --eta", HAMMER_ETA, "--duration", choose(2000, 400000))

    # a tip in a heat bath
    def bath(kelvin, quality):
        return ("--quality-factor", quality, "--temperature", kelvin * KELVIN) if quality else ()
    for kelvin, quality in BATHS:
        curve("thermal_" + bath_name(kelvin, quality), "--eta", choose("0.5:9:0.5 --duration 1000",
                                                                       "0.05:9:0.05 --duration 20000"),
              *bath(kelvin, quality))
        for eta in (2, 4, 6):
            curve("thermal_peak_%s_%g" % (bath_name(kelvin, quality), eta), "--eta",
                  "%g:%g:%g" % (eta - 0.5, eta + 0.5, choose(0.05, 0.01)),
                  "--duration", choose(500, 20000), *bath(kelvin, quality))
        for eta in THERMAL_FINE:  # between the points of the whole curve
            curve("thermal_fine_%s_%g" % (bath_name(kelvin, quality), eta), "--eta",
                  "%g:%g:0.05" % (eta - 0.225, eta + 0.225), "--duration", choose(500, 3000), *bath(kelvin, quality))
    for eta, quality, theta in kicks_cases(quick):
        for kicks in (GOLDEN[::3] if quick else GOLDEN) + (REFERENCE_KICKS,):
            curve(kicks_name(eta, quality, theta, kicks), "--eta", eta, "--quality-factor", quality, "--temperature",
                  theta, "--kicks-per-tau", kicks, "--duration", choose(1000, 100000), "--threads 1")
    add("thermal_real_time", "real_time --temperature 0.926 --quality-factor 100 --cutoff 0.05",
        choose("--eta 0:9:1 --tau 100", "--tau 5000"))
    add("thermostats", "thermostats --seconds", choose(0.2, 12))

    def windows(eta, theta, quality, window, duration):
        add(windows_name(eta, theta, quality, window, duration), "benchmark/friction_windows.py --eta", eta,
            "--temperature", theta, "--quality-factor", quality, "--window", window, "--duration",
            duration / choose(10, 1), "--transient 300 --starts 48")
    for eta, (_, window, temperatures) in HOPS.items():
        for theta in temperatures:
            windows(eta, theta, HOPS_QUALITY, window, 20000)
    for theta in TRACES:
        windows(6.5, theta, HOPS_QUALITY, 50, 20000)
    for eta in MERGE_ETAS:
        for quality in MERGE_QUALITIES:
            for kelvin in TEMPERATURES:
                windows(eta, kelvin * KELVIN, quality, 50, 5000)
    for eta in LOAD_ETAS:
        for name, heat in (("cold", ()), ("warm", bath(300, 100))):
            curve("load_%g_%s" % (eta, name), "--eta", eta, "--rest-height",
                  choose("-1.1:0.09:0.1 --duration 500", "-1.1:0.09:0.01 --duration 10000"), *heat)

    for lever in LEVERS:
        for crystal in CRYSTALS:
            words, most = lever_scene(lever, crystal)
            points = choose(5, 20)
            step = float("%.6g" % (most / points))  # so short that the range ends at 0 to the digit
            curve("lever_%s_%s" % (lever, crystal), words, "--rest-height",
                  "%.9g:0:%.9g --duration %d" % (-points * step, step, choose(300, 4000)))
    add("levers", "benchmark/levers.py", choose("--tau 30 --transient 20", ""))

    # accuracy, speed, stability
    add("speed_accuracy", "speed_accuracy",
        choose("--flights 60 --rounds 2 --seconds 0.05 --tau 200 --run-seconds 0.3",
               "--flights 200 --seconds 0.7 --run-seconds 3"), "--pace {out}/pace.csv", sides=["pace"])
    add("stability", "stability_matrix", choose("--quick --seconds 0.2", "--seconds 2"), may_fail=True)
    add("work_cost", "work_cost", choose("--impacts 100000 --tips 10000 --rounds 1", ""))
    for i in range(choose(1, 3)):
        add("verbs_%d" % i, "verbs --benchmark_min_time=%s --benchmark_format=csv" % choose("0.05", "0.5"))
        add("real_time_%d" % i, "real_time", choose("--tau 200 --transient 100", "--tau 1000 --transient 200"))
    add("burst_error", "burst_error --gamma 0.3 0.7 0.95 1 --bursts", choose(100, 1000), "--most-bounces 20000")
    add("burst_error_loaded", "burst_error --rest-height=-0.3 --eta 0.1 0.2 0.5 3 --bursts", choose(100, 1000),
        "--most-bounces 20000")
    add("burst_friction", "benchmark/tolerance_friction.py bursts",
        choose("--tau 1000 --eta 0.5 1.5 3 3.4 5 --most-events 2e6", "--tau 10000"))
    add("cutoff_friction", "real_time --eta 0.5 1.5 3 3.4 5 7 --cutoff 0.1 0.03 0.01 0.003 0.001 0.0003",
        choose("--tau 2000", "--tau 20000"), "--transient 500")
    add("grazes_flight", "grazes --kinds flight", choose("--flights 100 --ordinary 10000",
                                                         "--flights 3000 --ordinary 400000"))
    for study in ("search", "chatter"):
        add(study + "_constants", "benchmark/changed_constants.py", study)
    add("grazes_start", "grazes --kinds start --ordinary 10 --flights", choose(10, 100))
    add("grazes_tau", "grazes --kinds tau --ordinary 10 --flights", choose(3, 20))
    seconds = choose(15, 110)
    add("stress_any", "stress --seed 41000000 --seconds", seconds, may_fail=True)
    add("stress_mica", "stress --mica --tau 10000 --seed 91000 --seconds", seconds, may_fail=True)
    add("stress_levers", "stress --levers --tau 1000 --seed 51000000 --seconds", seconds, may_fail=True)
    add("stress_shipped", "stress --shipped --seed 5", choose("--tau 10000 --scenes 10", "--tau 100000 --scenes 100"),
        may_fail=True)

    add("collapse_friction", "benchmark/tolerance_friction.py collapse", choose("--tau 400 --eta 0.3", ""))
    for ratio, own in LEVER_KICKS.items():
        for kicks in (own, *MORE_KICKS):
            curve("lever_kicks_%g_%g" % (ratio, kicks), "--eta 2:6:2 --cutoff 0.05 --rest-height -0.3:0:0.3",
                  "--temperature 0.926 --quality-factor 100 --kicks-per-tau", kicks, "--frequency-ratio", ratio,
                  "--duration", choose(200, 50000))

    for ratio in LOCK_RATIOS:
        for quality in LOCK_QUALITIES:
            for kicks in LOCK_KICKS:
                curve("locked_kicks_%g_%g_%g" % (ratio, quality, kicks), "--eta 4 --cutoff 0.05 --temperature 0.926",
                      "--quality-factor", quality, "--kicks-per-tau", kicks, "--frequency-ratio", ratio,
                      "--duration", choose(200, 50000))

    for (ratio, quality), own in LIQUID_KICKS.items():
        for kicks in (own, *LIQUID_MORE):
            curve("liquid_kicks_%g_%g_%g" % (ratio, quality, kicks), "--eta 2:4:2 --cutoff 0.05 --rest-height -0.3",
                  "--temperature 0.02 --quality-factor", quality, "--kicks-per-tau", kicks, "--frequency-ratio", ratio,
                  "--duration", choose(200, 50000))

    # scenes, recording, control
    add("scene_levels", "model_error --scene glide paper resonance slow_motion splash sweep",
        choose("--duration 500", ""))
    add("recording_cost", "benchmark/record_throughput.py {out}/bags", choose(20, 600))
    add("topic_rates", "benchmark/topic_rates.py --seconds", choose(2, 10))
    add("panel_load", "benchmark/panel_load.py --seconds", choose(2, 20))
    add("durations", "benchmark/durations.py", choose("--only import", "--builds"))
    add("loop_delay", "benchmark/loop_delay.py --commands", choose(100, 1000))
    add("control_rates", "benchmark/control_rates.py --periods", choose(200, 4000))

    # reliability
    add("soak", "scripts/soak --seed 23 --duration", choose(60, 3600), may_fail=True)
    if quick:
        return all_commands
    for kind in ("address", "thread"):
        add("sanitized_" + kind, "scripts/sanitize", kind, may_fail=True)
    single = "AFM_BUILD_DIR=$PWD/build/single_version "
    add("leaks", single + "scripts/build --emulator -- -DAFM_NATIVE=OFF &&", single +
        'scripts/soak --duration 300 --time-scale 0.01 --under "valgrind --leak-check=full --error-exitcode=9"',
        may_fail=True)
    for target in FUZZED:
        add("fuzz_" + target, "scripts/fuzz --runs 1000000", target, "2>&1", may_fail=True)
    add("builds", "scripts/platforms --digests --older", may_fail=True)
    return all_commands
