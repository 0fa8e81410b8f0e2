#!/usr/bin/python3
"""The Snakefile has a rule for every table and picture of the documents, and makes some of them.

Usage: laboratory_test.py ROOT BUILD TOOLS     (BUILD: where the results go, in a folder of the test's own)
"""
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path
from types import SimpleNamespace

ROOT, BUILD, TOOLS = (Path(path).resolve() for path in sys.argv[1:4])
sys.path.insert(0, str(ROOT / 'workflow'))
import registry  # noqa: E402
import results  # noqa: E402
import summaries  # noqa: E402,F401  (registers the tables that are rendered)

SKIPPED = 77
# a recording of a user's own; made by scripts/platforms; rendered from others by workflow/documents.py
BY_OTHER_MEANS = {'run', 'platforms', 'compilers'}


def snakemake(*arguments):
    environment = dict(os.environ, AFM_BUILD_DIR=str(BUILD / 'laboratory_test'), AFM_TOOLS=str(TOOLS),
                       PATH='/usr/bin:' + os.environ['PATH'])
    return subprocess.run(['snakemake', '--snakefile', str(ROOT / 'Snakefile'), '--nolock', '-c2', *arguments],
                          env=environment,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)


class Laboratory(unittest.TestCase):
    def run_rules(self, *arguments):
        done = snakemake(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:])
        return done.stdout

    def test_every_rule_runs_dry(self):
        self.assertRegex(self.run_rules('all', '-n', '--quiet'), r'\nmeasure +\d{3}')

    def rules_and_documents(self):
        return (set(self.run_rules('--list').split()),
                ''.join(path.read_text() for path in [ROOT / 'README.md', *(ROOT / 'docs').glob('*.md')]))

    def test_every_name_that_a_document_gives_to_snakemake_is_a_rule(self):
        rules, text = self.rules_and_documents()
        for names in re.findall(r'^snakemake((?: \w+)+)', text, re.M):
            self.assertLessEqual(set(names.split()), rules)

    def test_every_table_and_picture_of_a_document_has_a_rule(self):
        rules, text = self.rules_and_documents()
        rendered = set(registry.SHORT_TABLES)
        for name in set(re.findall(r'(?:data|images)/(\w+)\.(?:csv|png|svg)', text)) - BY_OTHER_MEANS - rendered:
            self.assertIn('scene_pictures' if re.match('scene_(?!levels)', name) else name, rules)

    def test_tables_and_a_picture(self):
        shutil.rmtree(str(BUILD / 'laboratory_test'), ignore_errors=True)
        self.run_rules('mica_in_si', 'model_restitution', str(self.out('tables/hammer_direct.csv')), '--config',
                       'quick=1')
        measured, made = (self.out(name).read_text() for name in ('tables/hammer_direct.csv', 'data/mica_in_si.csv'))
        self.assertRegex(measured,
                         r'^# quick run of `friction_curve .*`, commit \S+.*, \d+ processors, '
                                    r'\d{4}-\d\d-\d\d, [\d.]+ s\neta,')
        shipped = (ROOT / 'docs/data/mica_in_si.csv').read_text()
        self.assertEqual(made.split('\n', 1)[1], shipped.split('\n', 1)[1])
        self.assertGreater(self.out('images/model_restitution.png').stat().st_size, 5000)

    @staticmethod
    def out(name):
        return BUILD / 'laboratory_test/laboratory/quick' / name

    def test_of_several_runs_the_best_counts(self):
        columns = 'name iterations real_time cpu_time time_unit times_real_time slowest_tau_us'.split()
        tables = SimpleNamespace(quick=False, strings=lambda n: [dict.fromkeys(columns, ('10', '9', '11')[int(n[-1])])])
        self.assertEqual([row['cpu_time'] for row in results.verbs(tables)], ['9'])
        row, = results.real_time(tables)
        self.assertEqual((row['times_real_time'], row['slowest_tau_us']), ('11', '9'))

    def test_what_failed_is_not_told_as_sound(self):
        tables = SimpleNamespace(
            stamp=lambda name: '# run of `x`, commit 1, a processor, 2000-01-01%s, 1 s' % (
                ', it ended with 1' if name in ('stress_mica', 'leaks') else ''),
            text=lambda name: '2 scenes of 3 tau: 4 commands, 5 segments, 6 impacts standing for 7 bounces, '
                              'in a tau 8, deepest 9 a, worst imbalance 10')
        self.assertEqual([row['violations'] for row in results.stress(tables)], ['0', 'at least 1', '0', '0'])
        self.assertEqual([row['what'] for row in results.reliability(tables) if 'FAILED: ' in row['result']], ['leaks'])
        ran = 'stat::number_of_executed_units: 1234567\n'
        self.assertEqual([results.fuzz_result(text) for text in ('', ran, ran + 'SUMMARY: timeout\n')], [
            'nothing was fuzzed', '1,234,567 inputs: no finding', '1,234,567 inputs: FAILED: SUMMARY: timeout'])


if __name__ == '__main__':
    version = subprocess.run(['snakemake', '--version'], stdout=subprocess.PIPE, universal_newlines=True).stdout
    if int(version.split('.')[0]) < 7:
        print('snakemake %s is too old: rules have no names by a variable' % version.strip())
        sys.exit(SKIPPED)
    unittest.main(argv=sys.argv[:1])
