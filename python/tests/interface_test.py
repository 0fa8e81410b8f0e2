#!/usr/bin/python3
"""Errors, arrays, stubs and documentation of the module."""
import ast
import inspect
import pickle
import re
import subprocess
import sys
import unittest
from pathlib import Path

import numpy as np

import afm
from afm import _afm

HERE = Path(afm.__file__).parent


class Errors(unittest.TestCase):
    def refused(self, name, value, call, *arguments, **options):
        with self.assertRaises(afm.ParameterError) as caught:
            call(*arguments, **options)
        fault = caught.exception
        self.assertEqual((fault.name, fault.value), (name, value))
        self.assertGreater(len(fault.reason), 10)
        self.assertIn('%s = %.17g: %s' % (name, value, fault.reason), str(fault))
        return fault

    def test_the_argument_is_named(self):
        self.refused('gamma', 1.5, afm.Model, gamma=1.5)
        self.refused('cutoff', -1, afm.Model, cutoff=-1)
        self.refused('rest_height', 0.2, afm.Model, rest_height=0.2)
        self.refused('amplitude', 2, afm.Model, amplitude=2)
        self.refused('frequency_ratio', 0, afm.Model, frequency_ratio=0)
        self.refused('surface_amplitude_m', 1, afm.Units, surface_amplitude_m=1)
        self.refused('quality_factor', 0.01, afm.Bath, quality_factor=0.01)
        self.refused('temperature', 1, afm.Bath, temperature=1)
        self.refused('y', -1, afm.Tip, y=-1)
        self.refused('eta', 2000, afm.Tip, eta=2000)
        self.refused('eta', 2000, afm.Tip().drag, 2000)
        self.refused('cutoff', -1, afm.Tip().change, cutoff=-1)
        self.refused('time', -1, afm.Tip().advance, -1)
        self.refused('period', 0, afm.Tip().samples, 0, 10)
        self.refused('sample_period', 0, afm.Emulator, sample_period=0)
        self.refused('friction_window', -1, afm.Emulator().change, friction_window=-1)
        self.refused('cutoff', -2, afm.friction_curve, [2.0], cutoff=[0.1, -2])
        self.refused('duration', 0, afm.friction_curve, 2.0, duration=0)
        self.refused('threads', -1, afm.friction_curve, 2.0, threads=-1)
        self.refused('starts', 0, afm.attractors, 2.0, starts=0)
        self.refused('eta', 0, afm.periodic_orbits, 0)
        self.refused('max_length', 99, afm.periodic_orbits, 2, max_length=99)
        self.refused('transient', -1, afm.lyapunov, transient=-1)
        self.refused('phase', 1e9, afm.next_impact, eta=2, phase=1e9, extension=0, u=2, w=1)

    def test_all_faults_of_a_call_are_there(self):
        with self.assertRaises(afm.ParameterError) as caught:
            afm.Model(gamma=-1, cutoff=-1, amplitude=-1)
        self.assertEqual({fault.name for fault in caught.exception.faults}, {'gamma', 'cutoff', 'amplitude', 'rest_height'})

    def test_errors_are_values(self):
        fault = pickle.loads(pickle.dumps(self.refused('gamma', 1.5, afm.Model, gamma=1.5)))
        self.assertEqual((fault.name, fault.value), ('gamma', 1.5))
        self.assertIsInstance(fault, ValueError)

    def test_words_that_are_no_choice(self):
        for call in (lambda: afm.Model(kind='saw'), lambda: afm.friction_curve(2.0, sweep='sideways'),
                     lambda: afm.next_impact(eta=2, phase=0, extension=0, u=2, w=1, on_error='ignore')):
            self.assertRaises(ValueError, call)
        self.assertRaises(TypeError, afm.next_impact, eta=2, speed=3)
        self.assertRaises(TypeError, afm.Emulator().change, colour=1)

    def test_a_state_without_a_next_impact(self):
        states = dict(eta=2, phase=[0.25, 0.25], extension=0, u=2, w=[-50, 5])
        with self.assertRaisesRegex(ValueError, 'state 0: .*does not leave'):
            afm.next_impact(**states)
        table = afm.next_impact(on_error='nan', **states)
        self.assertEqual(list(np.isnan(table['dt'])), [True, False])


class Arrays(unittest.TestCase):
    def test_events_are_not_copied(self):
        events = afm.Tip().advance(100)
        self.assertEqual(events.ndim, 1)
        self.assertFalse(events.flags.owndata)
        self.assertEqual(type(events.base).__name__, 'PyCapsule')
        self.assertTrue((events['kind'] == afm.Kind.IMPACT).any())
        self.assertTrue((np.diff(events['tau'] + events['phase']) >= 0).all())

    def test_arrays_outlive_the_tip(self):
        tip = afm.Tip()
        samples = tip.samples(0.1, 1000)
        before = samples.vertical.copy()
        tip.samples(0.1, 1000)
        del tip
        np.testing.assert_array_equal(samples.vertical, before)
        self.assertEqual((samples.times.shape, samples.times[0]), ((1000,), 0.0))

    def test_shapes_are_broadcast(self):
        table = afm.next_impact(eta=3.4, phase=np.linspace(0.1, 0.4, 3)[:, None], extension=0, u=3.4, w=np.arange(3, 7))
        self.assertEqual(table.shape, (3, 4))
        again = afm.next_impact(table, gamma=0.7)
        np.testing.assert_array_equal(table, again)

    def test_a_copy_of_a_tip_goes_on_alone(self):
        tip = afm.Tip()
        other = tip.copy()
        other.drag(2.0)
        other.advance(10)
        self.assertEqual((float(tip.now), tip.eta, other.eta), (0.0, 3.4, 2.0))

    def test_empty_stretches(self):
        self.assertEqual(len(afm.Tip().advance(0)), 0)
        self.assertEqual(len(afm.Tip().samples(0.1, 0).vertical), 0)
        self.assertEqual(len(afm.Emulator().run(0).vertical), 0)

    def test_models_are_values(self):
        self.assertEqual(afm.Model(gamma=0.8), afm.Model(gamma=0.8))
        self.assertNotEqual(afm.Model(gamma=0.8), afm.Model())
        self.assertEqual(eval(repr(afm.Model(gamma=0.1)), {'Model': afm.Model}), afm.Model(gamma=0.1))
        self.assertEqual(eval(repr(afm.Bath(0.3, 50)), {'Bath': afm.Bath}), afm.Bath(0.3, 50))
        with self.assertRaises(AttributeError):
            afm.Model().gamma = 0.5

    def test_model_times_keep_their_digits(self):
        late = afm.ModelTime(10**12, 0.1)
        self.assertEqual(late.after(0.95), afm.ModelTime(10**12 + 1, 0.1 + 0.95 - 1.0))


class Stubs(unittest.TestCase):
    @staticmethod
    def public(names):
        return {name for name in names if not name.startswith('_')}

    def test_they_say_what_is_there(self):
        stub = ast.parse((HERE / '_afm.pyi').read_text())
        types = {'Table', 'Time'}
        top = {node.name for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))} | {
            node.target.id for node in stub.body if isinstance(node, ast.AnnAssign)}
        self.assertEqual(top - types, self.public(dir(_afm)))
        for node in stub.body:
            if isinstance(node, ast.ClassDef):
                members = self.public(f.name for f in node.body if isinstance(f, ast.FunctionDef))
                self.assertEqual(members, self.public(dir(getattr(_afm, node.name))), node.name)

    def test_their_arguments_are_those_that_the_module_takes(self):
        for node in ast.parse((HERE / '_afm.pyi').read_text()).body:
            if isinstance(node, ast.ClassDef):
                init, = [f for f in node.body if getattr(f, 'name', '') == '__init__']
                names = [argument.arg for argument in init.args.args[1:]]
                documented = getattr(_afm, node.name).__init__.__doc__
                self.assertEqual(re.findall(r', (\w+): ', documented.splitlines()[0]), names, node.name)

    def test_everything_is_documented(self):
        for name in self.public(afm.__all__):
            item = getattr(afm, name)
            self.assertTrue(inspect.getdoc(item), name)
            for member in self.public(vars(item)) if inspect.isclass(item) and item.__module__ == 'afm._afm' else ():
                if callable(getattr(item, member)):
                    self.assertGreater(len(inspect.getdoc(getattr(item, member)) or ''), 40, '%s.%s' % (name, member))

    def test_types_agree(self):
        try:
            import mypy  # noqa: F401
        except ImportError:
            self.skipTest('mypy is not installed')
        done = subprocess.run([sys.executable, '-m', 'mypy', '--ignore-missing-imports', '--cache-dir', '/dev/null', '-p', 'afm'],
                              stdout=subprocess.PIPE, universal_newlines=True, cwd=str(HERE.parent))
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == '__main__':
    unittest.main()
