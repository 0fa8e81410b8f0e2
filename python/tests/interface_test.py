#!/usr/bin/python3
"""Errors, arrays, stubs and documentation of the module."""
import ast
import copy
import inspect
import math
import multiprocessing
import pickle
import re
import subprocess
import sys
import unittest
import warnings
from pathlib import Path

import numpy as np

import afm
from afm import _afm

HERE = Path(afm.__file__).parent


def stored_energy(model):
    return advanced(afm.Tip(model)).stored_energy


def advanced(tip):
    tip.advance(50)
    return tip


class Errors(unittest.TestCase):
    def refused(self, name, value, call, *arguments, **options):
        with self.assertRaises(afm.ParameterError) as caught:
            call(*arguments, **options)
        fault = caught.exception
        self.assertEqual((fault.name, fault.value), (name, value))
        self.assertGreater(len(fault.reason), 10)
        self.assertIn('%s = %r: %s' % (name, value, fault.reason), str(fault))
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
        with self.assertWarnsRegex(RuntimeWarning, 'temperature_k = 300: has no effect'):  # a node takes it too
            afm.Units().bath(temperature_k=300)
        self.refused('temperature_k', -1, afm.Units().bath, temperature_k=-1, quality_factor=100)
        self.refused('lattice_spacing_m', 0.52, afm.Units, lattice_spacing_m=0.52)
        self.refused('y', -1, afm.Tip, y=-1)
        self.refused('eta', 2000, afm.Tip, eta=2000)
        self.refused('eta', 2000, afm.Tip().drag, 2000)
        self.refused('cutoff', -1, afm.Tip().change, cutoff=-1)
        self.refused('time', -1, afm.Tip().advance, -1)
        self.refused('time', 1e30, afm.Tip().advance, (10 ** 30, 0.0))
        self.refused('period', 0, afm.Tip().samples, 0, 10)
        self.refused('sample_period', 0, afm.Run, sample_period=0)
        self.refused('friction_window', -1, afm.Run().apply, friction_window=-1)
        self.refused('eta', 2000, afm.Run().apply, eta=2000)
        self.refused('contact_tolerance', 1, afm.Run().apply, contact_tolerance=1)
        self.refused('gap', -1, afm.Run.from_snapshot, dict(afm.Run().snapshot(), gap=-1))
        self.refused('cutoff', -2, afm.friction_curve, [2.0], cutoff=[0.1, -2])
        self.refused('duration', 0, afm.friction_curve, 2.0, duration=0)
        self.refused('bath.stream', 3, afm.friction_curve, 2.0, bath=afm.Bath(0.9, 100, stream=3))
        self.refused('threads', -1, afm.friction_curve, 2.0, threads=-1)
        self.refused('starts', 0, afm.attractors, 2.0, starts=0)
        self.refused('eta', 0, afm.periodic_orbits, 0)
        self.refused('max_length', 99, afm.periodic_orbits, 2, max_length=99)
        self.refused('transient', -1, afm.lyapunov, transient=-1)
        self.refused('phase', 1e9, afm.next_impact, eta=2, phase=1e9, extension=0, u=2, w=1)
        for check in afm.kicks_lock, afm.suitable_kicks:
            self.assertRaisesRegex(ValueError, '^eta = nan', check, afm.Model(), afm.Bath(), math.nan)

    def test_a_lever_and_a_load_in_the_terms_of_their_owner(self):
        lever = dict(spring_constant_n_per_m=0.2, resonance_hz=13000.0, lateral_spring_constant_n_per_m=88.2)
        units = afm.Units(lattice_spacing_m=0.399e-9, load_n=0.4e-9, **lever)
        self.assertAlmostEqual(units.time * 13000.0, 1.0, delta=1e-15)
        self.assertAlmostEqual(units.model.rest_height * units.length / -2e-9, 1.0, delta=1e-14)
        self.assertAlmostEqual(units.model.frequency_ratio / math.sqrt(88.2 / 0.2), 1.0, delta=1e-14)
        self.assertEqual(pickle.loads(pickle.dumps(units)).model, units.model)
        self.refused('tip_mass_kg', 1e-12, afm.Units, tip_mass_kg=1e-12, **lever)
        self.refused('rest_height_m', -1e-9, afm.Units, rest_height_m=-1e-9, load_n=1e-9)
        self.refused('resonance_hz', 0, afm.Units, spring_constant_n_per_m=0.2, lateral_spring_constant_n_per_m=50)
        self.refused('load_n', math.inf, afm.Units, load_n=math.inf)
        self.refused('load_n', 1, afm.Units, load_n=1)

    def test_a_wrong_type_is_named(self):
        tip, run = afm.Tip(), afm.Run()
        for name, call in (('gamma', lambda: afm.Model(gamma='high')), ('gamma', lambda: afm.Model('high')),
                           ('kind', lambda: afm.Model(kind=3)), ('temperature', lambda: afm.Bath([1, 2])),
                           ('seed', lambda: afm.Bath(seed=-1)), ('seed', lambda: afm.Bath(seed=1.5)),
                           ('omega_v_rad_per_s', lambda: afm.Units('fast')), ('model', lambda: afm.Tip('hammer')),
                           ('bath', lambda: afm.Tip(bath=0.9)), ('u', lambda: afm.Tip(u='fast')),
                           ('time', lambda: tip.advance('later')), ('time', lambda: tip.advance((1, 'a'))),
                           ('most_events', lambda: tip.advance(1, -2)), ('count', lambda: tip.samples(0.1, -1)),
                           ('eta', lambda: tip.drag('fast')), ('gamma', lambda: tip.change(gamma='high')),
                           ('bath', lambda: tip.set_bath(None)), ('tips', lambda: afm.Ensemble(tip)),
                           ('sample_period', lambda: afm.Run(sample_period='short')),
                           ('impacts', lambda: run.advance(10, 'all')), ('cutoff', lambda: run.apply(cutoff='low')),
                           ('eta', lambda: afm.friction_curve('all')), ('eta', lambda: afm.friction_curve([[1], [2]])),
                           ('eta', lambda: afm.friction_curve([None])), ('eta', lambda: afm.friction_curve([2 + 1j])),
                           ('eta', lambda: afm.friction_curve(np.ma.array([2., 3.], mask=[1, 0]))),
                           ('eta', lambda: afm.friction_curve(np.array([2], 'm8[s]'))),
                           ('progress', lambda: afm.friction_curve(2, duration=1, progress=3)),
                           ('path', lambda: afm.from_bag([])), ('path', lambda: afm.from_bag(b'run.bag')),
                           ('duration', lambda: afm.friction_curve(2, duration='long')),
                           ('seed', lambda: afm.friction_curve(2, seed='one')),
                           ('bath', lambda: afm.friction_curve(2, bath=0.9)),
                           ('model', lambda: afm.friction_curve(2, model=1)),
                           ('sweep', lambda: afm.friction_curve(2, sweep=None)),
                           ('threads', lambda: afm.friction_curve(2, threads=2**40)),
                           ('threads', lambda: afm.Ensemble([tip], threads=2**40)),
                           ('model', lambda: afm.kicks_lock(1, 2)),
                           ('bath', lambda: afm.suitable_kicks(afm.Model(), None)),
                           ('snapshot', lambda: afm.Run.from_snapshot(5)),
                           ('seed', lambda: afm.friction_curve(2, seed=2**64)), ('seed', lambda: afm.Bath(seed=2**64)),
                           ('states', lambda: afm.next_impact([1, 2])), ('bath', lambda: run.apply(bath=3)),
                           ('kind', lambda: run.apply(kind=3)), ('impacts', lambda: run.advance(impacts=2**64)),
                           ('quality_factor', lambda: afm.friction_curve(2, bath=afm.Bath(), quality_factor=[1, 2])),
                           ('starts', lambda: afm.attractors(2, starts=0)),
                           ('eta', lambda: afm.next_impact(eta='2', phase=0, extension=0, u=0, w=1)),
                           ('starts', lambda: afm.attractors(2, starts='many')),
                           ('starts', lambda: afm.attractors(2, starts=[[1, 2]])),
                           ('eta', lambda: afm.periodic_orbits('fast')), ('u', lambda: afm.lyapunov(u='fast'))):
            with self.subTest(name):
                with self.assertRaises(afm.ArgumentTypeError) as caught:
                    call()
                self.assertEqual(caught.exception.name, name)
                self.assertRegex(str(caught.exception), '(?s)' + name + ' = .*: must be ')
                self.assertIsInstance(caught.exception, (TypeError, afm.ParameterError))
        self.assertRaisesRegex(TypeError, 'Model has no argument colour', afm.Model, colour=1)
        for call in (afm.Ensemble, afm.Run.from_snapshot, tip.advance, lambda: run.apply(1)):
            self.assertRaisesRegex(
                TypeError, r'^[A-Z][\w.]+ lacks an argument, or has one too many(; it has [\w, ]+)?$', call)
        self.refused('eta', math.inf, afm.Tip, eta=10 ** 400)

    def test_an_entry_of_a_snapshot_of_a_wrong_type(self):
        for name in ('model', 'bath', 'eta', 'time', 'sample_origin', 'window_begins'):
            snapshot = dict(afm.Run().snapshot())
            if name in snapshot:
                snapshot[name] = None
                self.assertRaisesRegex(TypeError, name + ' = None: ', afm.Run.from_snapshot, snapshot)

    def test_a_table_of_too_many_points_is_refused_at_once(self):
        """2**64 of them once were none, and fewer filled the memory."""
        many = np.linspace(0.1, 0.9, 2 ** 16)
        for table in (afm.friction_curve, afm.attractors):
            fault = self.refused('points of the table', 2.0 ** 64, table, many, gamma=many, cutoff=many,
                                 amplitude=many / 10)
            self.assertIn('at most 1e+06', str(fault))

    def test_heat_that_no_spring_takes(self):
        """The hammer has no lateral spring; such a row was once called thermal."""
        bath = dict(temperature=1.5, lateral_quality_factor=20.0)
        self.refused('temperature', 1.5, afm.friction_curve, 2.0, model='hammer', duration=200, **bath)
        with self.assertWarnsRegex(RuntimeWarning, 'lateral_quality_factor = 20: has no effect'):
            afm.Tip(afm.Model(kind='hammer'), bath=afm.Bath(**bath))

    def test_a_whole_float_is_a_whole_number(self):
        self.assertEqual(len(afm.Tip().samples(0.1, 5.0)), 5)
        for one in (1.0, np.float32(1)):
            self.assertEqual(len(afm.Tip(eta=3.4).advance(100, most_events=one)), 1)

    def test_all_faults_of_a_call_are_there(self):
        with self.assertRaises(afm.ParameterError) as caught:
            afm.Model(gamma=-1, cutoff=-1, amplitude=-1)
        self.assertEqual({fault.name for fault in caught.exception.faults},
                         {'gamma', 'cutoff', 'amplitude'})

    def test_errors_are_values(self):
        fault = pickle.loads(pickle.dumps(self.refused('gamma', 1.5, afm.Model, gamma=1.5)))
        self.assertEqual((fault.name, fault.value), ('gamma', 1.5))
        self.assertIsInstance(fault, ValueError)

    def test_words_that_are_no_choice(self):
        self.refused('kind', 'saw', afm.Model, kind='saw')
        self.refused('kind', 'saw', afm.Run().apply, kind='saw')
        self.refused('model', 'saw', afm.friction_curve, 2.0, model='saw')
        self.refused('sweep', 'sideways', afm.friction_curve, 2.0, sweep='sideways')
        self.refused('on_error', 'ignore', afm.next_impact, eta=2, phase=0, extension=0, u=2, w=1, on_error='ignore')
        falling = [3.0, 2.5, 2.0]  # once this swept up
        self.refused('eta', 2.5, afm.friction_curve, falling, sweep='down')
        self.assertRaises(TypeError, afm.next_impact, eta=2, speed=3)
        self.assertRaises(TypeError, afm.Run().apply, colour=1)

    def test_a_snapshot_that_is_none(self):
        snapshot = afm.Run().snapshot()
        with self.assertRaisesRegex(ValueError, 'lacks gap$'):
            afm.Run.from_snapshot({name: snapshot[name] for name in snapshot if name != 'gap'})
        with self.assertRaisesRegex(TypeError, 'no colour'):
            afm.Run.from_snapshot(dict(snapshot, colour=1))
        with self.assertRaisesRegex(ValueError, 'energy_bins: must hold 64'):
            afm.Run.from_snapshot(dict(snapshot, energy_bins=np.zeros(3)))

    def test_a_state_without_a_next_impact(self):
        states = dict(eta=2, phase=[0.25, 0.25], extension=0, u=2, w=[-50, 5])
        with self.assertRaisesRegex(ValueError, 'state 0: .*does not leave'):
            afm.next_impact(**states)
        table = afm.next_impact(on_error='nan', **states)
        self.assertEqual(list(np.isnan(table['dt'])), [True, False])


class Warnings(unittest.TestCase):
    """Kicks that lock to the swing of the lateral spring falsify K_f."""
    MODEL, BATH = afm.Model(frequency_ratio=14), afm.Bath(1, 20)

    def test_wherever_a_bath_meets_a_model(self):
        tip, run = afm.Tip(self.MODEL), afm.Run(self.MODEL)
        for call in (lambda: afm.Tip(self.MODEL, bath=self.BATH), lambda: tip.set_bath(self.BATH),
                     lambda: afm.Run(self.MODEL, bath=self.BATH), lambda: run.apply(bath=self.BATH),
                     lambda: afm.friction_curve(2, model=self.MODEL, bath=self.BATH, duration=10, transient=1),
                     lambda: afm.friction_curve([1, 2], frequency_ratio=[6.25, 14], temperature=1, quality_factor=20,
                                                duration=10, transient=1)):
            with self.assertWarnsRegex(RuntimeWarning, r'kicks_per_tau = 29\.034: .*give 46\.979') as caught:
                call()
            self.assertEqual((len(caught.warnings), caught.filename), (1, __file__))

    def test_kicks_that_lock_to_the_drag(self):
        model, bath, eta = afm.Model(), afm.Bath(1, 20), 29.034
        tip, run = afm.Tip(model, eta), afm.Run(model, eta)
        cold, still = afm.Tip(model, 2, bath=bath), afm.Run(model, 2, bath=bath)
        for call in (lambda: afm.Tip(model, eta, bath=bath), lambda: tip.set_bath(bath), lambda: cold.drag(-eta),
                     lambda: afm.Ensemble([cold, cold]).drag(eta),
                     lambda: afm.Run(model, eta, bath=bath), lambda: run.apply(bath=bath), lambda: still.apply(eta=eta),
                     lambda: afm.friction_curve([2, eta], model=model, bath=bath, duration=10, transient=1)):
            with self.assertWarnsRegex(RuntimeWarning, 'locks to the drag near eta = 29.034, .*give 46.979') as caught:
                call()
            self.assertEqual((len(caught.warnings), caught.filename), (1, __file__))
        self.assertTrue(afm.kicks_lock(model, bath, eta))
        self.assertFalse(afm.kicks_lock(model, bath))
        self.assertEqual(afm.suitable_kicks(model, bath, eta=eta), 46.979)

    def test_none_with_suitable_kicks(self):
        self.assertTrue(afm.kicks_lock(self.MODEL, self.BATH))
        kicks = afm.suitable_kicks(self.MODEL, self.BATH)
        bath = afm.Bath(1, 20, kicks_per_tau=kicks)
        self.assertFalse(afm.kicks_lock(self.MODEL, bath))
        with warnings.catch_warnings():
            warnings.simplefilter('error')
            afm.Tip(self.MODEL, bath=bath).copy()
            afm.friction_curve(2, model=self.MODEL, bath=bath, duration=10, transient=1)
            afm.Tip(bath=self.BATH)  # mica


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
        self.assertEqual(samples.times.shape, (1000,))
        np.testing.assert_allclose(samples.times, 0.1 * np.arange(1000))

    def test_shapes_are_broadcast(self):
        table = afm.next_impact(eta=3.4, phase=np.linspace(0.1, 0.4, 3)[:, None], extension=0, u=3.4, w=np.arange(3, 7))
        self.assertEqual(table.shape, (3, 4))
        again = afm.next_impact(table, gamma=0.7)
        np.testing.assert_array_equal(table, again)

    def test_a_batch_ends_by_its_budget(self):
        for wanted in (None, 1000):
            self.assertEqual(len(afm.Run(impact_budget=5).advance(impacts=wanted).impacts), 5)

    def test_empty_stretches(self):
        self.assertEqual(len(afm.Tip().advance(0)), 0)
        self.assertEqual(len(afm.Tip().samples(0.1, 0).vertical), 0)
        self.assertEqual(len(afm.Run().advance(0).vertical), 0)

    def test_what_can_be_pickled(self):
        units = afm.Units(tip_mass_kg=1e-10)
        warm = units.bath(temperature_k=300, quality_factor=50)
        for value in (afm.Model(gamma=0.8, kind='hammer'), warm, afm.Bath(0.9, 100, seed=2**63, stream=3)):
            for other in (pickle.loads(pickle.dumps(value)), copy.deepcopy(value), copy.copy(value)):
                self.assertEqual(other, value)
        self.assertEqual(copy.deepcopy(units).model, units.model)
        self.assertEqual(copy.deepcopy(units).force, units.force)
        ensemble = afm.Ensemble([afm.Tip(eta=2.0), afm.Tip(eta=3.4)], threads=2)
        ensemble.advance(10)
        other = pickle.loads(pickle.dumps(ensemble))
        np.testing.assert_array_equal([tip.eta for tip in other], [2.0, 3.4])
        for tip, same in zip(ensemble, other):
            np.testing.assert_allclose(same.state, tip.state, rtol=0, atol=1e-12)
        self.assertGreater(other.advance(20).min(), 0)

    def test_what_stands_in_the_way_of_a_snapshot_is_said(self):
        held = afm.Model(kind='hammer', rest_height=-1.0)
        tip = afm.Tip(held, eta=0.0, phase=0.5, y=-held.amplitude)
        tip.advance(2)
        tip.drag(0.2)
        with self.assertRaisesRegex(ValueError, 'still to be reported'):
            pickle.dumps(tip)
        tip.advance(tip.now)
        pickle.dumps(tip)
        ensemble = afm.Ensemble([afm.Tip(held, eta=0.0, phase=0.5, y=-held.amplitude)])
        ensemble.advance(2)
        ensemble.drag(0.2)
        self.assertRaisesRegex(ValueError, 'still to be reported', pickle.dumps, ensemble)
        np.testing.assert_array_equal(ensemble.advance(2) > 0, [True])
        pickle.dumps(ensemble)

    def test_a_copy_of_a_tip_goes_on_with_the_same_bits(self):
        for tip in (afm.Tip(eta=0.5, contact_tolerance=1e-4), afm.Tip(eta=3.4, bath=afm.Bath(0.926, 100)),
                    afm.Tip(afm.Model(kind='hammer'))):
            tip.advance(123.456)
            others = tip.copy(), copy.copy(tip), copy.deepcopy(tip)
            events = tip.advance(500)
            for other in others:
                np.testing.assert_array_equal(events, other.advance(500))
                self.assertEqual(tip.state, other.state)

    def test_what_is_pickled_goes_on_with_the_same_motion(self):
        for tip in (afm.Tip(eta=0.5, contact_tolerance=1e-4), afm.Tip(eta=3.4, bath=afm.Bath(0.926, 100)),
                    afm.Tip(afm.Model(kind='hammer')), afm.Tip(afm.Model(cutoff=0.005), eta=0.05)):
            for i in range(50):
                tip.advance(tip.now.after(0.789))
                pickled = pickle.dumps(tip)
                others = [pickle.loads(pickled), pickle.loads(pickled)]
                # in a chatter sequence the state is that without its bounces, which the pickled tip begins again
                np.testing.assert_allclose(others[0].state, tip.state, rtol=0, atol=1e-4)
                self.assertEqual(others[0].now, tip.now)
                np.testing.assert_array_equal(others[0].advance(tip.now.after(20)),
                                              others[1].advance(tip.now.after(20)))

    def test_the_processes_of_a_pool_take_them(self):
        models = [afm.Model(gamma=g) for g in (0.6, 0.7, 0.8)]
        with multiprocessing.Pool(2) as pool:
            self.assertEqual(pool.map(stored_energy, models), [stored_energy(model) for model in models])
            tips = pool.map(advanced, [afm.Tip(model) for model in models])
        np.testing.assert_allclose([tip.state for tip in tips], [advanced(afm.Tip(model)).state for model in models],
                                   rtol=0, atol=1e-13)

    def test_each_tip_of_an_ensemble_is_as_alone(self):
        alone = [afm.Tip(eta=eta, bath=afm.Bath(0.5, 50, stream=i)) for i, eta in enumerate((0.5, 2.0, 3.4))]
        ensemble = afm.Ensemble(alone, threads=2)
        events = ensemble.advance(200)
        self.assertEqual(list(events), [len(tip.advance(200)) for tip in alone])
        self.assertEqual([ensemble[i].state for i in range(len(ensemble))], [tip.state for tip in alone])
        ensemble.drag(1.0)
        self.assertEqual({tip.eta for tip in ensemble}, {1.0})
        self.assertEqual([ensemble[-i].state for i in (1, 2, 3)], [tip.state for tip in alone[::-1]])
        self.assertRaises(afm.ParameterError, ensemble.advance, 100)

    def test_a_bath_of_a_curve_is_that_of_its_numbers(self):
        by_bath = afm.friction_curve(2.0, bath=afm.Bath(0.926, 100, 50, 20, seed=4), duration=100)
        by_numbers = afm.friction_curve(2.0, temperature=0.926, quality_factor=100, lateral_quality_factor=50,
                                        kicks_per_tau=20, seed=4, duration=100)
        self.assertEqual(str(by_bath), str(by_numbers))
        self.assertRaises(afm.ParameterError, afm.friction_curve, 2.0, bath=afm.Bath(0.9, 9), temperature=0.1)

    def test_a_map_of_basins_has_a_label_for_each_start(self):
        table, starts = afm.attractors(3.75, cutoff=0.375, starts=20, friction_duration=100, labels=True)
        self.assertEqual(len(starts), 20)
        counts = np.bincount(starts['attractor_row'], minlength=len(table))
        np.testing.assert_allclose(counts / 20, table['basin'])
        self.assertLessEqual({'period-1', 'chaotic'}, set(table['attractor']))  # friction depends on history
        self.assertEqual(len(set(table['k_f'])), len(table))
        given = np.array(starts[['phase', 'extension', 'y', 'u', 'w']].tolist())[:5]
        _, again = afm.attractors([3.75, 2.0], cutoff=0.375, starts=given, friction_duration=100, labels=True)
        self.assertEqual((list(again['point']), len(again)), ([0] * 5 + [1] * 5, 10))
        np.testing.assert_allclose(again['w'][:5], given[:, 4])
        with self.assertRaises(afm.ParameterError) as caught:
            afm.attractors(3.75, starts=[[0, 0, -1, 0, 0]])
        self.assertEqual(caught.exception.name, 'y')

    def test_a_batch_says_where_it_was(self):
        run = afm.Run(eta=2.0, phase=0.125, sample_period=0.03, samples_per_batch=100)
        for i in range(3):
            batch = run.advance()
            self.assertEqual((batch.eta, batch.first_sample), (2.0, 100 * i))
            self.assertAlmostEqual(float(batch.begin), 3.0 * i, delta=1e-12)
            self.assertAlmostEqual(batch.holder, 0.125 + 2.0 * float(batch.first_sample_time), delta=1e-12)
            self.assertAlmostEqual(float(batch.first_sample_time), 3.0 * i, delta=1e-12)
        self.assertEqual((run.samples, run.impacts), (300, batch.first_impact + len(batch.impacts)))

    def test_a_change_is_of_what_it_names(self):
        tip = afm.Tip(eta=2.0)
        tip.change(gamma=0.5, rest_height=-0.02)
        self.assertEqual(tip.model, afm.Model(gamma=0.5, rest_height=-0.02))
        tip.change(cutoff=0.1)
        self.assertEqual(tip.model, afm.Model(gamma=0.5, cutoff=0.1, rest_height=-0.02))

    def test_a_tip_is_in_contact_from_where_it_begins_to_where_it_ends(self):
        tip, seen = afm.Tip(afm.Model(cutoff=0.05), eta=0.3), set()
        for _ in range(2000):
            event, = tip.advance(10000, most_events=1)
            seen.add(afm.Kind(event['kind']))
            self.assertEqual(tip.in_contact, event['kind'] == afm.Kind.CONTACT_BEGUN)
        self.assertLessEqual({afm.Kind.CONTACT_BEGUN, afm.Kind.CONTACT_ENDED}, seen)

    def test_the_exponents_of_an_orbit_are_its_multipliers(self):
        found = afm.lyapunov(2.0, duration=700.0, transient=300.0)
        row, = afm.attractors(2.0, starts=[[0.25, 0, 0.2, 2.0, 0]])
        self.assertEqual((found.outcome, found.rank), ('measured', 4))
        self.assertAlmostEqual(found.duration, 700.0, delta=1.0)
        np.testing.assert_allclose(found.exponents, [row['lyapunov_%d' % i] for i in range(1, 5)], atol=0.01)
        self.assertTrue((found.std_errors >= 0).all() and (found.std_errors < 0.1).all())
        self.assertEqual(afm.lyapunov(3.4, most_events=10).outcome, 'budget_spent')

    def test_models_are_values(self):
        for value, other in ((afm.Model(gamma=0.1), afm.Model()), (afm.Bath(0.3, 50), afm.Bath()),
                             (afm.Units(lattice_spacing_m=0.399e-9), afm.Units())):
            self.assertTrue(value == eval(repr(value), vars(afm)) and value != other and value != None)  # noqa: E711
            self.assertIn(value, [None, 1, value])
        with self.assertRaises(AttributeError):
            afm.Model().gamma = 0.5

    def test_the_time_of_an_event_is_a_time(self):
        event = afm.Tip(eta=2.0).advance(10)[-1]
        again = afm.Tip(eta=2.0)
        self.assertEqual(again.advance((event['tau'], event['phase']))[-1], event)

    def test_model_times_keep_their_digits(self):
        late = afm.ModelTime(10**12, 0.1)
        self.assertEqual(late.after(0.95), afm.ModelTime(10**12 + 1, 0.1 + 0.95 - 1.0))
        self.assertEqual(afm.ModelTime(5, 0.0).after(-1e-17), afm.ModelTime(5, 0.0))


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
                members = self.public(f.target.id if isinstance(f, ast.AnnAssign) else f.name for f in node.body)
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
                least = 40 if callable(getattr(item, member)) else 2
                self.assertGreater(len(inspect.getdoc(getattr(item, member)) or ''), least, '%s.%s' % (name, member))

    def test_every_field_is_documented(self):
        for item in (afm.Batch, afm.Lyapunov, afm.Samples, afm.State):
            for field in item._fields:
                self.assertNotIn('Alias for field', inspect.getdoc(getattr(item, field)), field)
        self.assertEqual(len({kind.__doc__ for kind in afm.Kind}), len(afm.Kind))

    def test_they_say_which_k_f_is_friction(self):
        for item in (afm, afm.friction_curve, afm.Batch.friction):
            self.assertIn('k_f_work', inspect.getdoc(item))

    def test_types_agree(self):
        try:
            import mypy  # noqa: F401
        except ImportError:
            self.skipTest('mypy is not installed')
        done = subprocess.run([sys.executable, '-m', 'mypy', '--ignore-missing-imports', '--cache-dir', '/dev/null',
                               '-p', 'afm'],
                              stdout=subprocess.PIPE, universal_newlines=True, cwd=str(HERE.parent))
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == '__main__':
    unittest.main()
