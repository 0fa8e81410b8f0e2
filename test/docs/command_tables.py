"""What the test of the documented commands runs otherwise than it stands there, and what it does not run."""

# (pattern, replacement), applied to every command in turn; each must be used. They make long runs short.
SUBSTITUTIONS = [
    # the build directory belongs to the tree itself, not to the copy in which commands run
    (r'^scripts/(run|build)\b', r'"$AFM_ROOT/scripts/\1"'),
    (r'(scripts/run")(?: --duration \S+)?', r'\1 --duration 3'),
    (r'^cmake --install build/without_ros', r'cmake --install "${AFM_BUILD_DIR:-$AFM_ROOT/build}"'),
    # the test consumer builds the others
    (r'^(cmake --build ~/afm/examples)', r'\1 --target one_tip'),
    # these go on until Ctrl-C
    (r'^rostopic echo', 'rostopic echo -n 1'),
    (r'^(roslaunch afm_emulator (?:emulator|view|hold_force|seek_peak)\.launch|roslaunch .*view:=true)',
     r'until_interrupted \1'),
    # a bag as a killed emulator leaves it
    (r'^rosbag reindex (\S+)\.active', r'cp \1 \1.active && rosbag reindex \1.active'),
    # fewer points, starts, guesses, rounds
    (r'--eta 0\.02:9:0\.01', '--eta 2:3:0.5'),
    (r'--eta 0\.2:9:0\.01 --gamma 0\.3:0\.95:0\.05',
     '--eta 2:3:0.5 --gamma 0.5:0.7:0.1 --duration 100 --transient 100'),
    (r'--eta 0\.03:9:0\.03 --gamma 0\.3:0\.95:0\.01', '--eta 2:3:0.5 --gamma 0.5:0.7:0.1'),
    (r'--eta 1\.6:7:0\.02', '--eta 2.4:2.6:0.02'),
    (r'--eta 0\.1:9:0\.1 --frequency', '--eta 2:3:1 --starts 1 --duration 200 --frequency'),
    (r'--eta 0\.1:9:0\.1$', '--eta 2:2.5:0.5'),
    (r'--starts (?:100|400)\b', '--starts 4'),
    (r'--max-length (?:8|10)\b', '--max-length 3'),
    (r'(periodic_orbits --eta 3\.4 --gamma 0\.7)', r'\1 --max-length 2'),
    (r'(periodic_orbits .*)', r'\1 --trajectory 5000 --guesses 50'),
    (r'(symbolic_dynamics )', r'\1--impacts 20000 --guesses 50 '),
    (r'(level_table) --', r'\1 --starts 1 --duration 100 --'),
    (r'(level_table) (>config)', r'\1 --starts 1 --duration 100 --eta 2 --gamma 0.7 --cutoff 0.1 \2'),
    (r'--gamma 0\.8 --cutoff 0\.02', '--eta 2 --gamma 0.7 --cutoff 0.1'),
    (r'--eta 0\.25:8\.95:0\.3', '--eta 2.05 --gamma 0.7 --cutoff 0.1'),
    (r'--eta 0\.05:9:0\.05', '--eta 2:2.5:0.5'),
    (r'(model_error --scene.*)', r'\1 --duration 100'),
    (r'2e-6:2e-5:2e-6', '2e-6:2e-5:9e-6'),
    (r'(record_throughput\.py \S+) 600', r'\1 3'),
    (r'--benchmark_min_time=0\.5', '--benchmark_min_time=0.001'),
    (r'(--benchmark_filter=\S+)', r'\1 --benchmark_min_time=0.001'),
    (r'(friction_peaks|bifurcations)\.py', r'\1.py 5'),
    (r'(friction_of_lever\.py \S+ \S+)', r'\1 0.1e-9 5 #'),
    (r'(many_machines\.py \S+)', r'\1 --points 3 --duration 100'),
    (r'(thermal_histogram)\.py', r'\1.py 10000'),
    (r'(durations\.py)(?! --)', r'\1 --only import'),
    (r'--tau (400000|300000|5000)\b', '--tau 50'),
]

# (pattern, why the command is not run); each must be used. The tools of these commands must know the options used.
NOT_RUN = [
    (r'^scripts/test', 'this test is a part of it'),
    (r'^scripts/run --(view|panel)', 'opens a window'),
    (r'^rosrun afm_emulator panel', 'opens a window'),
    (r'^snakemake', 'measures for minutes to hours; the test laboratory runs every rule dry, and some'),
    (r'^cmake (-S \. .*-DAFM_ROS=OFF|--build build/without_ros)', 'the test without_ros does it'),
    (r'run_tests_my_controller', 'the test my_controller does it'),
    (r'^scripts/fuzz', 'builds with clang for minutes'),
    (r'^scripts/platforms(?! --list)', 'builds with every compiler, or makes roots of other systems and tests in them'),
    (r'durations\.py --builds', 'builds everything for minutes'),
    (r'^dask-|--scheduler HEAD', 'needs a second machine'),
    (r'^podman', 'needs a container engine'),
    (r'^(rqt_plot|rosrun rqt_\w+) ', 'opens a window'),
    (r'^python3 -m venv', 'builds for minutes; the test without_ros does it in short'),
]

# programs that are built only where the machine has what they need
OPTIONAL = {'verbs': 'Google Benchmark'}
