"""The level that a shipped scene states is as near to the finest as the scene says. usage: scene_levels_test.py MODEL_ERROR SCENES"""
import csv
import subprocess
import sys
import unittest
from pathlib import Path

TOOL, SCENES = sys.argv.pop(1), Path(sys.argv.pop(1))
ALLOWED = {'glide': ('deflection_error', 0.01), 'slow_motion': ('k_f_error', 0.01)}  # K_f within 2 % in the others
WITHOUT = {'rest', 'room', 'loop'}  # at rest there is no friction; with a bath levels are not compared


class SceneLevels(unittest.TestCase):
    def test_the_error_is_what_the_scene_allows(self):
        scenes = sorted({path.stem for path in SCENES.glob('*.yaml')} - WITHOUT)
        text = subprocess.check_output([TOOL, '--duration', '4000', '--scene'] + scenes, universal_newlines=True)
        rows = list(csv.DictReader(text.splitlines()))
        points = {(row['scene'], row['eta']) for row in rows}
        self.assertEqual({scene for scene, _ in points}, set(scenes))
        in_use = [row for row in rows if row['in_use'] == '1']
        self.assertEqual({(row['scene'], row['eta']) for row in in_use}, points)
        self.assertEqual(len(in_use), len(points))
        for row in in_use:
            column, most = ALLOWED.get(row['scene'], ('k_f_error', 0.02))
            self.assertLess(float(row[column]), most, row)


if __name__ == '__main__':
    unittest.main()
