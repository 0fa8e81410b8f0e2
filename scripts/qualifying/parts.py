"""The parts of scripts/qualify: what runs, how long it takes, what it needs, and where its results go."""
from collections import namedtuple

from . import keep

# quick and full: commands (a tool, or a path in the tree; SCRATCH: a directory of the part's own); minutes: of both on two quiet
# cores; needs: {command: Debian package}; optional: programs of which a tree may do without
Part = namedtuple("Part", "name about quick full minutes keep needs optional keeps_failures")

SIMPLE_FIGURES = ("model_setup model_restitution model_force fig1_friction fig1_coexistence fig2_attractor fig3_orbit fig4_scan "
                  "fig5_averages fig6_even_orbit fig7_atlas fig8_bifurcations fig9_scaling hammer_friction hammer_error hammer_ratio "
                  "hammer_section hammer_cycles")
THERMAL_FIGURES = "thermal_friction thermal_accuracy thermal_hops load"
SINGLE = "AFM_BUILD_DIR=$PWD/build/single_version"
VALGRIND = '"valgrind --leak-check=full --error-exitcode=9"'
FUZZING = (("csv_filter", 30), ("parameters", 5), ("bag_messages", 60), ("tip", 140))  # targets, and minutes of each
FIGURES = "scripts/figures --tables SCRATCH/tables --data SCRATCH"
SMALL_FIGURES = "scripts/figures --quick --output SCRATCH --tables SCRATCH/tables --data SCRATCH"
CHART_FILES = "--output SCRATCH/speed_accuracy.csv --pace SCRATCH/pace.csv"
SHORT_RUNS = "--cutoff 0.1 0.03 --most-events"


def part(name, about, quick, full, minutes, keep, needs=None, optional=(), keeps_failures=False):
    return Part(name, about, quick, full, minutes, keep, needs or {}, optional, keeps_failures)


PARTS = [
    # accuracy.md
    part("chart", "speed against accuracy of every method",
         ["speed_accuracy --flights 60 --rounds 2 --seconds 0.05 --tau 200 --run-seconds 0.3 " + CHART_FILES],
         ["speed_accuracy --flights 200 --seconds 0.7 --run-seconds 3 " + CHART_FILES],
         (4, 10), keep.files("speed_accuracy.csv", "pace.csv"), optional=("speed_accuracy",)),
    part("matrix", "methods against the scenes on which methods fail",
         ["stability_matrix --quick --seconds 0.2 --output SCRATCH/stability.csv"],
         ["stability_matrix --seconds 2 --output SCRATCH/stability.csv"],
         (2, 12), keep.files("stability.csv"), optional=("stability_matrix",), keeps_failures=True),
    part("work", "cost against work: impacts, tips, threads",
         ["work_cost --impacts 100000 --tips 10000 --rounds 1"], ["work_cost"], (0.5, 1), keep.printed("work_cost.csv")),
    # speed.md
    part("verbs", "time of each step of the core",
         ["verbs --benchmark_min_time=0.05 --benchmark_format=json"], ["verbs --benchmark_min_time=0.5 --benchmark_format=json"],
         (0.5, 1), keep.verbs, optional=("verbs",)),
    # stability.md
    part("real_time", "724 points of real time",
         ["real_time --tau 200 --transient 100"], ["real_time --tau 1000 --transient 200"] * 3, (0.5, 1), keep.real_time),
    part("burst_errors", "chatter sequences against bounces one by one",
         ["burst_error --eta 0.2 0.5 3 5 7 --bursts 300 --most-bounces 20000"],
         ["burst_error --eta 0.2 0.5 3 5 7 --bursts 3000 --most-bounces 20000"], (1, 3), keep.printed("burst_error.csv")),
    part("burst_friction", "K_f with chatter sequences and bounce by bounce",
         ["burst_friction --tau 1000 --eta 0.5 1.5 3 3.4 5 " + SHORT_RUNS + " 2e6"], ["burst_friction --tau 10000 " + SHORT_RUNS + " 2e7"],
         (0.5, 2), keep.printed("burst_friction.csv")),
    part("cutoffs", "K_f as the cutoff goes to zero",
         ["real_time --eta 0.5 1.5 3 3.4 5 7 --cutoff 0.1 0.03 0.01 0.003 0.001 0.0003 --tau 2000 --transient 500"],
         ["real_time --eta 0.5 1.5 3 3.4 5 7 --cutoff 0.1 0.03 0.01 0.003 0.001 0.0003 --tau 20000 --transient 500"],
         (0.5, 2), keep.printed("cutoff_friction.csv")),
    part("grazes", "grazing flights against 113 bits",
         ["grazes --kinds flight --flights 100 --ordinary 10000", "grazes --kinds start --flights 10 --ordinary 10",
          "grazes --kinds tau --flights 3 --ordinary 10"],
         ["grazes --kinds flight --flights 3000 --ordinary 400000", "grazes --kinds start --flights 100 --ordinary 10",
          "grazes --kinds tau --flights 20 --ordinary 10"],
         (1, 8), keep.grazes, optional=("grazes",)),
    part("stress", "random models under random commands",
         ["stress --seed 41000000 --seconds 15", "stress --mica --tau 10000 --seed 91000 --seconds 15",
          "stress --shipped --tau 10000 --scenes 10 --seed 5"],
         ["stress --seed 41000000 --seconds 110", "stress --mica --tau 10000 --seed 91000 --seconds 110",
          "stress --shipped --tau 100000 --scenes 100 --seed 5"],
         (1, 5), keep.stress, keeps_failures=True),
    # scenes.md, recording.md, steering.md
    part("levels", "the table of levels, measured again beside the shipped one",
         ["level_table --output SCRATCH/levels.csv"], ["level_table --output SCRATCH/levels.csv"], (0.5, 0.5), keep.levels),
    part("scenes", "what each scene's level gives, and the pictures of the scenes",
         ["scripts/scene_levels --duration 500 --output SCRATCH/scene_levels.csv"],
         ["scripts/scene_levels --output SCRATCH/scene_levels.csv", "scripts/plot_scenes"], (1, 3), keep.files("scene_levels.csv")),
    part("recording", "what a long recording costs", ["benchmark/record_throughput.py SCRATCH/bags 20"],
         ["benchmark/record_throughput.py SCRATCH/bags 600"], (0.5, 12), keep.recording, optional=("benchmark/record_throughput.py",)),
    part("loop_delay", "how long a controller waits for its command",
         ["benchmark/loop_delay.py --commands 100 --output SCRATCH/loop_delay.csv"],
         ["benchmark/loop_delay.py --commands 1000 --output SCRATCH/loop_delay.csv"],
         (0.5, 1), keep.files("loop_delay.csv"), optional=("benchmark/loop_delay.py",)),
    # reliability.md
    part("soak", "a long run under random commands", ["scripts/soak --duration 60 --seed 23"],
         ["scripts/soak --duration 3600 --seed 23", "scripts/soak --duration 900 --time-scale 2.5 --sample-rate 200000"],
         (1.5, 77), keep.soak, keeps_failures=True),
    part("address", "every test under the address and undefined-behaviour sanitizers", [], ["scripts/sanitize address"],
         (0, 30), keep.sanitized, keeps_failures=True),
    part("thread", "every test under the thread sanitizer", [], ["scripts/sanitize thread"], (0, 35), keep.sanitized, keeps_failures=True),
    part("leaks", "a run under valgrind", [],
         [SINGLE + " scripts/build --emulator -- -DCMAKE_CXX_FLAGS=-DAFM_SINGLE_VERSION",
          SINGLE + " scripts/soak --duration 300 --time-scale 0.01 --any-memory --any-bits --under " + VALGRIND],
         (0, 15), keep.leaks, needs={"valgrind": "valgrind"}, keeps_failures=True),
    *[part("fuzz_" + target, "inputs that reach new code of " + target, [], ["scripts/fuzz --runs 1000000 %s 2>&1" % target],
           (0, minutes), keep.fuzz, needs={"clang++": "clang"}, keeps_failures=True) for target, minutes in FUZZING],
    part("builds", "the same bits from every compiler and for older machines", [], ["scripts/compare_builds --older"], (0, 3),
         keep.builds, needs={"qemu-x86_64": "qemu-user"}, keeps_failures=True),
    part("platforms", "the package in roots of other systems", [], ["scripts/platforms"], (0, 240), keep.nothing,
         optional=("scripts/platforms",)),
    # friction.md, temperature.md
    part("temperature", "figures of a tip in a heat bath", [SMALL_FIGURES + " --only load"], [FIGURES + " --only " + THERMAL_FIGURES],
         (0.5, 15), keep.figures),
    part("figures", "figures of the paper and of the hammer", [SMALL_FIGURES + " --only fig1_friction"],
         [FIGURES + " --only " + SIMPLE_FIGURES], (0.5, 10), keep.figures),
]
