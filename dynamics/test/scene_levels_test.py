"""The level that each shipped scene runs is as far from the finest as its table says. usage: scene_levels_test.py TOOLS
SCRIPTS"""
import importlib.util
import math
import sys
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

TOOLS, SCRIPTS = Path(sys.argv.pop(1)).resolve(), Path(sys.argv.pop(1))
loader = SourceFileLoader('scene_levels', str(SCRIPTS / 'scene_levels'))
scene_levels = importlib.util.module_from_spec(importlib.util.spec_from_loader('scene_levels', loader))
loader.exec_module(scene_levels)


class SceneLevels(unittest.TestCase):
    def test_error_is_what_is_said(self):
        known = set()
        for found in scene_levels.examine(TOOLS, 4000):
            with self.subTest(scene=found['scene'], eta=found['eta']):
                if math.isnan(found['expected']):
                    self.assertEqual(found['eta'], 0.0, 'the table knows all speeds of the shipped scenes but rest')
                    continue
                self.assertLess(found['expected'], found['tolerance'])
                self.assertLessEqual(found['error'], found['expected'] + found['noise'])
                self.assertLess(found['noise'], 0.05)
                known.add(found['scene'])
        self.assertEqual(known, {p.stem for p in (scene_levels.CONFIG / 'scenes').glob('*.yaml')} -
                         {'rest', 'room', 'loop'})


if __name__ == '__main__':
    unittest.main()
