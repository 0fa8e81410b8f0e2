#!/usr/bin/python3
"""A recording with something altered in it: what and where is reported, also by the exit code."""
import bags
import checks
import digest_recipe
from emulator_under_test import SPEED_UNIT, run
from spoiled_bag import SpoiledBag, flip_last_bit


class SpoiledBags(SpoiledBag):
    def test_as_it_was(self):
        self.assert_reported(checks.SOUND, 'IDENTICAL')

    def test_an_independent_reader_gets_the_same_digests(self):
        messages = bags.read(str(self.good))
        self.assertEqual(digest_recipe.of_configuration(messages['configuration'][0]),
                         messages['digest'][-1].configuration_digest)
        for reported in messages['digest']:
            def part(topic, count, size=lambda m: 1):
                got, total = [], 0
                for message in messages[topic]:
                    if total < count:
                        got.append(message)
                        total += size(message)
                self.assertEqual(total, count, topic)
                return got
            self.assertEqual(digest_recipe.of_samples(part('deflection', reported.samples, lambda m: len(m.vertical))),
                             reported.samples_digest)
            self.assertEqual(digest_recipe.of_impacts(part('impacts', reported.impacts, lambda m: len(m.impacts))),
                             reported.impacts_digest)
            applied = digest_recipe.in_order(messages['applied_drag'], messages['applied_parameters'])
            self.assertEqual(digest_recipe.of_messages(applied[:reported.commands]), reported.commands_digest)
            self.assertEqual(digest_recipe.of_messages(part('friction', reported.estimates)), reported.estimates_digest)

    def test_one_bit_of_one_sample(self):
        flip_last_bit(self.of('deflection')[100], -8)
        reported = self.assert_reported(checks.ALTERED, 'deflection.lateral', 'ALTERED')
        self.assertIn('batch 100', reported.text)
        self.assertIn('last command', reported.text)

    def test_one_bit_of_one_impact(self):
        full = next(e for e in self.of('impacts')[90:] if e.message().impacts)
        flip_last_bit(full, -13)  # of the energy loss, before kind and count
        self.assert_reported(checks.ALTERED, 'impacts.energy_loss', 'ALTERED')

    def test_one_bit_of_one_estimate(self):
        flip_last_bit(self.of('friction')[100], -8)
        self.assert_reported(checks.ALTERED, 'friction.heat_to_bath', 'ALTERED')

    def test_another_command(self):
        self.of('applied_drag')[1].edit(drag_velocity=2.1 * SPEED_UNIT)
        self.assert_reported(checks.ALTERED, 'ALTERED')

    def test_another_configuration(self):
        self.of('configuration')[0].edit(initial_height=0.21)
        self.assert_reported(checks.ALTERED, 'ALTERED')

    def test_another_change_of_parameters(self):
        first, second = self.of('applied_parameters')
        second.edit(rest_height_m=-2.1e-12)
        self.assert_reported(checks.ALTERED, 'ALTERED')
        second.edit(rest_height_m=1.0)
        self.assert_reported(checks.ALTERED, 'rest_height_m = 1: ')
        second.edit(rest_height_m=-2.0e-12, first_sample=second.message().first_sample + 1)
        self.assert_reported(checks.ALTERED, 'not between its samples')
        first.edit(restitution_gamma=0.71)
        self.assert_reported(checks.ALTERED, 'live parameters of its configuration')

    def test_a_configuration_that_cannot_be(self):
        self.of('configuration')[0].edit(restitution_gamma=7.0)
        self.assert_reported(checks.ALTERED, 'restitution_gamma')

    def test_a_digest(self):
        self.of('digest')[1].edit(samples_digest=1)
        self.assert_reported(checks.ALTERED, 'digest.samples_digest')
        self.assertEqual(checks.replay_check('--digests-only', self.write()).code, checks.DIFFERS)

    def test_a_true_recording_of_something_else(self):
        """As from a machine that computes otherwise: true to its digests, but not what is simulated here."""
        configuration = self.of('configuration')[0]
        configuration.edit(initial_height=0.2000000000000001)
        digest = digest_recipe.of_configuration(configuration.message())
        for entry in self.of('digest'):
            entry.edit(configuration_digest=digest)
        self.assert_reported(checks.DIFFERS, 'DIFFERENT', 'as it was published')
        self.assertEqual(checks.replay_check('--digests-only', self.write()).code, checks.DIFFERS)

    def test_a_time_far_away_is_not_run_to(self):
        message = self.of('friction')[100].message()
        message.time.tau += 10**15
        self.of('friction')[100].put(message)
        self.assert_reported(checks.ALTERED, 'friction.time')

    def begin_with_batch_50(self):
        """As of a recording that was begun later, by someone who leaves nothing that counts or tells."""
        self.remove_digests()
        self.remove(*self.of('recording'), *[e for topic in ('deflection', 'impacts', 'friction') for e in self.of(topic)[:50]])

    def test_a_beginning_far_away_is_not_run_to(self):
        self.begin_with_batch_50()
        self.assert_reported(checks.TRUNCATED, 'IDENTICAL as far as it goes')
        for sample in (10**12, 10**18, 2**64 - 1):
            self.of('deflection')[0].edit(first_sample=sample)
            self.assert_reported(checks.ALTERED, 'deflection.time', 'for sample %d' % sample)
        self.remove(self.of('friction')[0])  # so that no end is reported
        self.assert_reported(checks.ALTERED, 'deflection.time')

    def test_an_end_far_away_without_samples_is_not_run_to(self):
        for batch in (0, 1):
            with self.subTest(batch=batch):
                self.setUp()
                self.begin_with_batch_50()
                message = self.of('friction')[batch].message()
                message.time.tau += 10**12
                self.of('friction')[batch].put(message)
                self.remove(self.of('deflection')[batch], *self.of('impacts')[:batch + 1])
                answer = checks.replay_check(self.write())
                self.assertIn('friction.time', answer.text)
                self.assertEqual(answer.code, checks.DIFFERS)

    def test_a_time_that_no_run_has(self):
        for topic in ('deflection', 'friction'):
            for tau, phase in ((-1, 0.5), (2**62, 0.5), (5, 1.5), (5, float('nan'))):
                self.setUp()
                message = self.of(topic)[100].message()
                message.time.tau, message.time.phase = tau, phase
                self.of(topic)[100].put(message)
                self.assert_reported(checks.ALTERED, topic, 'batch 100', 'no run can be')

    def assert_bad(self, *subjects):
        answer = checks.bag_check(self.write())
        bad = [line.split('  ')[1][4:].strip() for line in answer.text.splitlines() if line.startswith('  BAD')]
        self.assertEqual(bad, list(subjects), answer.text)
        self.assertEqual(answer.code, 1 if subjects else 0)
        self.assertEqual(checks.replay_check(self.write()).code, checks.DIFFERS if subjects else checks.SOUND)

    def edit_impact(self, **factors):
        """Of a single impact that stands alone: with two samples between it and each of those beside it."""
        def apart(a, b):
            return b.time.tau - a.time.tau + b.time.phase - a.time.phase > 0.25
        for entry in self.of('impacts')[100:]:
            message = entry.message()
            for before, impact, after in zip(message.impacts[1:], message.impacts[2:], message.impacts[3:]):
                alone = apart(before, impact) and apart(impact, after)
                if alone and impact.kind == impact.IMPACT and impact.normal_speed > 1e-6:
                    for name, factor in factors.items():
                        setattr(impact, name, getattr(impact, name) * factor)
                    return entry.put(message)
        self.fail('no impact to edit')

    def test_physics_alone_tells(self):
        """Without digests bag_check still knows what an impact, a flight and a mean are."""
        def sample():
            message = self.of('deflection')[100].message()
            message.vertical = [y * (1 + 1e-9) for y in message.vertical]
            self.of('deflection')[100].put(message)

        def heat():
            for entry in self.of('friction')[60:]:
                entry.edit(heat_to_bath=1e-6 * entry.message().energy_loss)

        def loss():
            for entry in self.of('friction')[60:]:
                entry.edit(energy_loss=(1 + 1e-9) * entry.message().energy_loss)
        spoils = [
            ((), lambda: None),
            (('impact law', 'energy balance', 'energy lost', 'K_f'), lambda: self.edit_impact(energy_loss=1 + 1e-6)),
            (('impact law', 'energy balance'), lambda: self.edit_impact(normal_speed=1 + 1e-6)),
            (('energy balance',), lambda: self.edit_impact(tangential_velocity=1 + 1e-6)),
            (('energy balance',), sample),
            (('K_f',), lambda: self.of('friction')[100].edit(k_f=self.of('friction')[100].message().k_f * (1 + 1e-9))),
            (('work',), heat),
            (('work', 'energy lost'), loss)]
        for subjects, spoil in spoils:
            with self.subTest(subjects=subjects):
                self.setUp()
                self.remove_digests()
                spoil()
                self.assert_bad(*subjects)

    def test_the_time_of_a_batch(self):
        message = self.of('deflection')[100].message()
        message.time.phase = (message.time.phase + 0.25) % 1
        self.of('deflection')[100].put(message)
        self.assert_reported(checks.ALTERED, 'deflection.time', 'or itself')


if __name__ == '__main__':
    run(SpoiledBags)
