"""Launch tests of ROS 2, files with generate_test_description(), are run by pytest."""

from __future__ import annotations

import pytest

pytest_plugins = ["pytester"]

# The second line of each file is indented: the plugin would take this file for a launch test, else.
GOOD = """
    import sys, unittest
    import launch, launch_ros.actions, launch_testing, launch_testing.actions, pytest, rclpy
    from launch_testing_ros import DataRepublisher, WaitForTopics
    from std_msgs.msg import String

    @pytest.mark.launch_test
    @launch_testing.markers.keep_alive
    @launch_testing.parametrize("word", ["ho", "hu"])
    def generate_test_description(word):
        talker = launch_ros.actions.Node(executable=sys.executable, arguments=["talker.py", "chatter"], name="ada")
        once = launch.actions.ExecuteProcess(cmd=[sys.executable, "-c", f"print('{word}')"])
        ready = launch_testing.event_handlers.StdoutReadyListener(
            target_action=talker, ready_txt="here", actions=[launch_testing.actions.ReadyToTest()])
        actions = [talker, once, launch.actions.RegisterEventHandler(ready)]
        return launch.LaunchDescription(actions), {"talker": talker, "once": once}

    class TestTalker(unittest.TestCase):
        @classmethod
        def setUpClass(cls, test_args):
            rclpy.init()
            cls.node = rclpy.create_node("tester")

        @classmethod
        def tearDownClass(cls):
            rclpy.shutdown()

        def setUp(self, word):
            self.word = word

        def test_output(self, proc_output, proc_info, once):
            proc_output.assertWaitFor(self.word, once)
            proc_info.assertWaitForShutdown(once)
            self.proc_info.assertWaitForStartup("ada")

        def test_topics(self):
            with WaitForTopics([("chatter", String)], timeout=20.0) as waiter:
                assert waiter.received_messages("chatter")[0].data.startswith("hello")
            with pytest.raises(RuntimeError, match="no message within 0.2 s on nothing"):
                WaitForTopics([("nothing", String)], timeout=0.2).__enter__()

        def test_republisher(self):
            change = DataRepublisher(self.node, "chatter", "changed", String, lambda said: String(data=said.data + "!"))
            heard = []
            self.node.create_subscription(String, "changed", heard.append, 10)
            while len(heard) < 2:
                rclpy.spin_once(self.node, timeout_sec=20.0)
            self.assertTrue(heard[0].data.endswith("!"))
            self.assertGreaterEqual(change.get_num_republished(), 2)
            change.shutdown()

    @launch_testing.post_shutdown_test()
    class TestAfterwards(unittest.TestCase):
        def test_exit_codes(self, proc_info):
            launch_testing.asserts.assertExitCodes(proc_info)
            assert len(list(proc_info)) == 2
    """

TALKER = """
    import sys
    import rclpy
    from rclpy.executors import ExternalShutdownException
    from std_msgs.msg import String

    def main():
        rclpy.init()
        node = rclpy.create_node("talker")
        publisher = node.create_publisher(String, sys.argv[1], 10)
        node.create_timer(0.1, lambda: publisher.publish(String(data="hello from " + node.get_name())))
        print("here", flush=True)
        try:
            rclpy.spin(node)
        except (KeyboardInterrupt, ExternalShutdownException):
            pass

    if __name__ == "__main__":
        main()
    """


def run(project: pytest.Pytester, *options: str) -> pytest.RunResult:
    """Run the tests of a project in a process of its own."""
    return project.runpytest_subprocess("-p", "no:cacheprovider", "-p", "no:xdist", "-v", *options)


@pytest.mark.processes
def test_processes_run_while_their_tests_do(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(talker=TALKER, test_talker=GOOD)
    result = run(pytester, "--strict-markers")
    result.assert_outcomes(passed=8)
    names = [
        "TestTalker*::test_output",
        "TestTalker*::test_republisher",
        "TestTalker*::test_topics",
        "TestAfterwards*::test_exit_codes",
    ]
    result.stdout.fnmatch_lines(
        [f"test_talker.py::{each.replace('*', f'[[]{word}[]]')} PASSED*" for word in ("ho", "hu") for each in names]
    )


BAD = """
    import sys, unittest
    import launch, launch_testing, launch_testing.actions

    def generate_test_description():
        once = launch.actions.ExecuteProcess(cmd=[sys.executable, "-c", "print('said'); raise SystemExit(3)"])
        return launch.LaunchDescription([once, launch_testing.actions.ReadyToTest()])

    class TestIt(unittest.TestCase):
        def test_in_vain(self, proc_output, proc_info):
            proc_output.assertWaitFor("said", timeout=20)
            proc_info.assertWaitForShutdown("python", timeout=20)  # else it may be ended before it ends
            proc_output.assertWaitFor("never", timeout=0)

        def test_asks(self, proc_outptu): pass

        def test_equal(self, test_args): self.assertEqual(test_args, {"a": "1"})

        def test_sub(self):
            with self.subTest("x"): self.fail("in a part")

        @unittest.skip("not now")
        def test_skipped(self): pass

        @unittest.expectedFailure
        def test_expected(self): self.fail()

        @unittest.expectedFailure
        def test_unexpected(self): pass

    @launch_testing.post_shutdown_test()
    class TestAfterwards(unittest.TestCase):
        def test_codes(self, proc_info): launch_testing.asserts.assertExitCodes(proc_info)
    """


@pytest.mark.processes
def test_failures_show_the_tests_own_lines(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(test_bad=BAD)
    result = run(pytester, "--launch-args", "a:=2")
    result.assert_outcomes(failed=6, skipped=1, xfailed=1)
    result.stdout.fnmatch_lines(
        [
            "test_asks asks for 'proc_outptu' (did you mean 'proc_output'?): there is proc_info, *",
            "*self.assertEqual(test_args*",
            "E*AssertionError: {'a': '2'} != {'a': '1'}",
            ">*proc_output.assertWaitFor*never*",
            "E*AssertionError: Waiting for output timed out: 'never' *",
            "*in a part",
            "it was expected to fail, and did not",
            "E*AssertionError: python ended with 3, and [[]0[]] was expected",
        ]
    )
    assert "unittest/case.py" not in result.stdout.str()


STARTS = """
    import sys, unittest
    import launch, launch_testing, launch_testing.actions
    from launch.actions import ExecuteProcess

    def generate_test_description():
        return launch.LaunchDescription([launch_testing.actions.ReadyToTest()])

    class TestIt(unittest.TestCase):
        def start(self, text, launch_service, proc_info, proc_output):
            process = ExecuteProcess(cmd=[sys.executable, "-u", "-c", text])
            return launch_testing.tools.launch_process(launch_service, process, proc_info, proc_output)

        def test_ends(self, launch_service, proc_info, proc_output):
            with self.start("print('a'); raise SystemExit(4)", launch_service, proc_info, proc_output) as process:
                self.assertTrue(process.wait_for_shutdown(timeout=30))
            self.assertEqual((process.exit_code, process.output, process.running), (4, "a\\n", False))

        def test_is_ended(self, launch_service, proc_info, proc_output):
            text = "import time; print('b'); time.sleep(100)"
            with self.start(text, launch_service, proc_info, proc_output) as process:
                self.assertTrue(process.wait_for_output(lambda output: "b" in output, timeout=30))
                self.assertFalse(process.wait_for_output(lambda output: "c" in output, timeout=0.1))
                self.assertTrue(process.running)
            self.assertTrue(process.wait_for_shutdown(timeout=30))
    """


@pytest.mark.processes
def test_a_test_starts_and_ends_processes(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(test_starts=STARTS)
    run(pytester).assert_outcomes(passed=2)


MISTAKES = {
    "LaunchDescription([])": "*must return a LaunchDescription containing a ReadyToTest action",
    "[]": "generate_test_description() returned list, not a LaunchDescription",
    "LaunchDescription([ReadyToTest(), Node(executable='x', nmae='y')])": "Node has no argument 'nmae' (did you mean",
    "1 / 0": "E*ZeroDivisionError: division by zero",
}


@pytest.mark.processes
def test_mistakes_of_the_description_are_told_for_each_test(pytester: pytest.Pytester) -> None:
    text = """
    import unittest
    from launch import LaunchDescription
    from launch_ros.actions import Node
    from launch_testing.actions import ReadyToTest

    def generate_test_description():
        return MADE

    class TestIt(unittest.TestCase):
        def test_it(self): pass
    """
    pytester.makepyfile(**{f"test_{n}": text.replace("MADE", made) for n, made in enumerate(MISTAKES)})
    pytester.makepyfile(test_last="def generate_test_description_of(): pass\ndef test_plain(): pass")
    result = run(pytester)
    result.assert_outcomes(errors=len(MISTAKES), passed=1)
    result.stdout.fnmatch_lines([f"*{each}*" for each in MISTAKES.values()])


@pytest.mark.processes
def test_a_launch_without_test_methods_is_one_test(pytester: pytest.Pytester) -> None:
    text = """
    import sys
    import launch, launch_testing, launch_testing.actions, pytest

    @pytest.mark.launch_test
    def generate_test_description():
        process = launch.actions.ExecuteProcess(cmd=[sys.executable, "-c", "print('here', flush=True)"])
        ready = launch_testing.event_handlers.StdoutReadyListener(
            target_action=process, ready_txt="SAID", actions=[launch_testing.actions.ReadyToTest()])
        return launch.LaunchDescription([process, launch.actions.RegisterEventHandler(ready)])

    def test_start(proc_info, proc_output):
        assert False
    """
    pytester.makepyfile(test_it=text.replace("SAID", "here"), test_never=text.replace("SAID", "nothing"))
    result = run(pytester)
    result.assert_outcomes(passed=1, errors=1, warnings=2)
    result.stdout.fnmatch_lines(
        [
            "test_it.py::TestLaunch::test_processes_get_ready PASSED*",
            "*test_start() is not run: a launch test has its tests in classes of unittest.TestCase*",
        ]
    )
