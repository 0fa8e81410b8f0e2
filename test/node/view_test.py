"""The view draws what the emulator tells: tip, path and impacts over the surface where they were, at any speed."""
import math
import os
import re

import rospy
from afm_emulator.msg import Impact
from visualization_msgs.msg import MarkerArray

from emulator_under_test import FRICTION_UNIT, SPEED_UNIT, Emulator, EmulatorTest, NodeTest
from pictures import CELLS, CONTACT_RED, Picture, Reported, View, luminance, open_rviz, surface
from topics import Topic, wait_until

SLOW = {'time_scale': 3e-4, 'sample_rate_hz': 1e6, 'batch_rate_hz': 50.0}
EXACT = 1e-6          # cells: the exact place, after sums over some hundred tau


def hears_deflection():
    _, subscribers, _ = rospy.get_master().getSystemState()[2]
    return '/afm_view' in dict(subscribers).get('/afm/deflection', [])


class ViewTest(EmulatorTest):
    @classmethod
    def setUpClass(cls):
        cls.view = View()
        cls.view.markers.wait_for(cls.says_that_nothing_comes, 'a picture without an emulator')
        super().setUpClass()

    @classmethod
    def tearDownClass(cls):
        super().tearDownClass()
        cls.view.clean_up()

    def setUp(self):
        if self.view.markers not in Topic.all_open():  # opened in a test, and closed after it
            self.view.markers = Topic('/afm_view/markers', MarkerArray)
        super().setUp()

    def tearDown(self):
        super().tearDown()
        self.assertIsNone(self.view.child.poll(), 'the view has ended')

    @staticmethod
    def says_that_nothing_comes(message):
        """With a line beside it: rviz draws no text that is alone."""
        picture = Picture(message)
        return picture.has('path') and picture.text('time') == 'no messages from an emulator yet'

    def wait_for_tip(self):
        return self.view.markers.wait_for(lambda m: Picture(m).has('tip'), 'a picture with the tip')

    def picture_of_now(self):
        """And what it must show: the emulator is paused, and the view comes to where it stands."""
        def shown():
            picture, reported = Picture(self.view.markers.messages[-1]), Reported(self.topics)
            time, X, Y = reported.last_sample()
            right = (reported.centre(time) - reported.middle(time) + X, reported.height(time) + Y)
            here = picture.has('tip') and math.dist(picture.tip(), right) < EXACT
            complete = picture.spots() == len(reported.events_seen(time))  # impacts come on another topic than the tip
            return (picture, reported, time) if here and complete else None
        return wait_until(shown, 'a picture of where the emulator has stopped')

    def assert_sane(self, picture):
        shown = ''.join(str(m).replace(m.text, '') for m in picture.markers.values())
        self.assertNotRegex(shown, r'\b(nan|inf)\b')
        self.assertEqual({m.header.frame_id for m in picture.markers.values()}, {'afm'})
        self.assertEqual([m.pose.orientation.w for m in picture.markers.values()], [1.0] * len(picture.markers))

    def assert_surface(self, picture, middle):
        profile = picture.places('surface')
        self.assertAlmostEqual(profile[-1][0] - profile[0][0], CELLS, delta=EXACT)
        for x, y in profile:
            self.assertAlmostEqual(y, surface(x + middle), delta=10 * EXACT)

    def assert_above_surface(self, places, middle):
        self.assertTrue(places)
        for x, y in places:
            self.assertGreater(y, surface(x + middle) - 10 * EXACT)

    def assert_impacts(self, picture, reported, time):
        seen = reported.events_seen(time)
        for name, kinds in (('impacts', (Impact.IMPACT, Impact.BURST)),
                            ('contacts', (Impact.CONTACT_BEGUN, Impact.CONTACT_ENDED))):
            wanted, places = [x for x, e in seen if e.kind in kinds], picture.places(name)
            self.assertEqual(len(places), len(wanted), name)
            for (x, y), right in zip(places, wanted):
                self.assertAlmostEqual(x, right, delta=EXACT)
                self.assertAlmostEqual(y, surface(x + reported.middle(time)), delta=10 * EXACT)
        return [e for _, e in seen if e.kind in (Impact.IMPACT, Impact.BURST)]

    def assert_lighter_is_more(self, picture, impacts):
        light = [luminance(c) for c in picture.markers['impacts'].colors]
        by_energy = [l for _, l in sorted(zip([i.energy_loss for i in impacts], light))]
        self.assertEqual(by_energy, sorted(light))
        self.assertGreater(len(set(light)), 1)

    def shows_friction(self):
        """K_f and its error as they were reported last, to the decimals shown."""
        friction = self.topics['friction'].messages[-1]
        shown = re.match(r'K_f ([\d.]+) \+- ([\d.]+) m_tip/tau$',
                         Picture(self.view.markers.messages[-1]).text('friction'))
        return shown and all(
            float(number) > 0.0 and abs(float(number) - right) < 0.51 * 10.0 ** -len(number.split('.')[1])
            for number, right in zip(shown.groups(),
                                     (friction.k_f_work_natural, friction.k_f_work_std_error / FRICTION_UNIT)))

    def assert_shows_all(self):
        picture, reported, time = self.picture_of_now()
        middle = reported.middle(time)
        self.assert_sane(picture)
        self.assert_surface(picture, middle)
        self.assert_above_surface(picture.places('path') + [picture.tip()], middle)
        impacts = self.assert_impacts(picture, reported, time)
        self.assertFalse(picture.has('positions'))
        self.assertEqual(picture.has('contact'), reported.events[-1].kind == Impact.CONTACT_BEGUN)
        return picture, impacts


class SlowMotion(ViewTest):
    """Stepped, so that what a picture must show is known."""
    parameters = SLOW

    def setUp(self):
        super().setUp()
        self.wait_for_tip()  # it is connected
        self.begin(paused=True)

    def test_tip_path_and_impacts(self):
        self.stepped(9)
        picture, impacts = self.assert_shows_all()
        self.assertGreater(len(impacts), 1)
        self.assert_lighter_is_more(picture, impacts)
        path = picture.places('path')
        for place in picture.places('impacts'):
            self.assertLess(min(math.dist(place, corner) for corner in path), EXACT)
        self.assertEqual(picture.text('drag'), 'drag 11255.4 nm/s')
        self.assertEqual(picture.text('eta'), 'eta 3.400')
        wait_until(self.shows_friction, 'K_f as reported')

    def test_follows_the_holder_up_and_down(self):
        for height in (-3e-11, 2e-11):
            self.assertEqual(self.emulator.set(rest_height_m=height)['rest_height_m'], height)
            self.stepped(4)
            self.assert_shows_all()

    def test_words_and_figures_beside_the_surface(self):
        self.emulator.set(temperature_k=300.0, quality_factor=100.0)
        self.stepped(9.5)
        shown = {name: marker.text for name, marker in self.picture_of_now()[0].markers.items()}
        self.assertLessEqual({
            'length': '0.52 nm', 'key_0': '0.01', 'key_1': '0.1', 'key_2': '1', 'key_3': '10', 'key_4': '100',
            'key_title': 'energy lost in an impact [zJ]',
            'time': '9 tau; 300 K, Q = 100; 3333.33 times slower than real time'}.items(), shown.items())

    def test_marks_contact(self):
        eta = 0.2  # a third of the time in contact
        self.emulator.set(cutoff_speed=0.1 * eta * SPEED_UNIT)
        self.drag(eta)
        self.stepped(9)

        def slides():
            self.stepped(0.7)
            events = Reported(self.topics).events
            return events and events[-1].kind == Impact.CONTACT_BEGUN
        wait_until(slides, 'contact')
        picture, reported, time = self.picture_of_now()
        self.assert_surface(picture, reported.middle(time))
        x, y = picture.tip()
        self.assertAlmostEqual(y, surface(x + reported.middle(time)), delta=1e-3)
        self.assertEqual(picture.text('contact'), 'contact')
        for colour in (picture.markers['tip'].color, picture.markers['path'].colors[-1],
                       picture.markers['contacts'].colors[-1]):
            self.assertAlmostEqual(colour.r, CONTACT_RED, delta=1e-6)


class RealTime(ViewTest):
    def test_listens_only_while_somebody_looks(self):
        self.wait_for_tip()
        self.assertTrue(hears_deflection())
        self.view.markers.close()
        wait_until(lambda: not hears_deflection(), 'the view listens no more')
        self.view.markers = Topic('/afm_view/markers', MarkerArray)
        self.wait_for_tip()

    def test_a_stroboscope(self):
        self.topics['deflection'].wait_for(lambda m: m.first_sample > 200000, 'a second of the run')
        # on a slow machine the view may be at the end of the epoch before
        self.view.markers.wait_for_next(lambda m: Picture(m).has('tip'), 'the tip')
        first = len(self.view.markers.messages)
        self.view.markers.wait_for_more(60)
        pictures = [Picture(m) for m in self.view.markers.messages[first:]]
        self.assertLess(max(len(raw) for raw in self.view.markers.raw), 400000)  # of some 6700 samples a picture
        self.assertLess((len(pictures) - 1) / (pictures[-1].stamp - pictures[0].stamp), 33.0)
        for picture in pictures[::10]:
            self.assert_sane(picture)
            self.assert_surface(picture, 0.0)  # which stands still, a crest in the middle
            self.assertLessEqual(len(picture.places('positions')), 31 * 64)
            self.assertLessEqual(len(picture.places('impacts')), 31 * 40)
            self.assert_above_surface(picture.places('positions') + picture.places('path'), 0.0)
            for x, y in picture.places('impacts'):
                self.assertAlmostEqual(y, surface(x), delta=1e-4)
        self.assertGreater(len(pictures[-1].places('positions')), 20 * 64)
        # what stands still is followed
        self.pause(True)
        self.view.markers.wait_for_next(lambda m: not Picture(m).has('positions'), 'the cloud has faded')
        self.stepped(9)
        self.view.markers.wait_for_next(lambda m: not Picture(m).has('positions'), 'it has faded again')
        self.assert_shows_all()


class Launched(NodeTest):
    def test_without_rviz_or_a_display_everything_else_runs(self):
        nowhere = open_rviz(PATH=self.temporary_directory(), DISPLAY=':0')
        self.assertEqual(nowhere.returncode, 0)
        self.assertIn('install', nowhere.stdout)
        environment = {name: value for name, value in os.environ.items() if 'DISPLAY' not in name}
        play = self.launch('emulator.launch', environment, view='true')
        markers, deflection = Topic('/afm_view/markers', MarkerArray), Topic('deflection')
        markers.wait_for(lambda m: Picture(m).has('tip'), 'the tip')
        wait_until(lambda: 'so there is no window' in play.output(), 'why there is no window')
        deflection.wait_for_next()
        play.stop()

    def test_a_tip_that_rests_for_good_is_in_contact(self):
        """Who begins to look hears of no event."""
        self.start(Emulator({'drag_velocity': 0.0, 'load_n': 1e-9}))
        Topic('deflection').wait_for(lambda m: m.first_sample > 20000, 'a tenth of a second')
        view = self.start(View())
        drawn = view.markers.wait_for(lambda m: Picture(m).has('tip'), 'the tip')
        self.assertEqual(Picture(drawn).text('contact'), 'contact')

    def test_a_replay_looks_the_same(self):
        emulator = self.record(record=True)
        Topic('deflection').wait_for(lambda m: m.first_sample >= 200000, 'a second of the run')
        bag, = self.end(emulator)
        environment = {name: value for name, value in os.environ.items() if 'DISPLAY' not in name}
        replay = self.launch('replay.launch', environment, view='true', bag=bag, delay=5)
        markers = Topic('/afm_view/markers', MarkerArray)
        drawn = markers.wait_for(lambda m: Picture(m).has('tip') and Picture(m).has('positions'), 'the tip')
        self.assertTrue(Picture(drawn).has('surface'))
        wait_until(lambda: '[replay' in replay.output() and 'finished cleanly' in replay.output(), 'the bag has ended')
        markers.wait_for_next(what='the last picture stays')
        replay.stop()
