"""Tests of launch_pytest: launches that fixtures describe, and tests beside and after them."""

from __future__ import annotations

import pytest

pytest_plugins = ["pytester"]

GOOD = """
    import sys
    import launch_pytest, pytest
    from launch import LaunchDescription
    from launch.actions import ExecuteProcess
    from launch_pytest import tools

    TEXT = "import sys, time; print('out', flush=True); print('err', file=sys.stderr, flush=True); time.sleep(100)"

    @pytest.fixture(scope="module")
    def order():
        return []

    @launch_pytest.fixture(scope="module", params=["a", "b"])
    def described(request):
        process = ExecuteProcess(cmd=[sys.executable, "-c", TEXT], cached_output=True)
        return LaunchDescription([process, launch_pytest.actions.ReadyToTest()]), process, request.param

    @pytest.mark.launch(fixture=described, shutdown=True)
    def test_after(described, order, launch_service):
        order.append("after " + described[2])
        assert launch_service.event_loop is None
        assert described[1].return_code is not None

    @pytest.mark.launch(fixture=described)
    async def test_coroutine(described, order, launch_context, event_loop):
        order.append("coroutine " + described[2])
        assert launch_context.asyncio_loop is event_loop
        assert await tools.wait_for_start(launch_context, described[1], timeout=20)
        assert await tools.wait_for_output(launch_context, described[1], lambda said: "out" in said, timeout=20)
        assert not await tools.wait_for_exit(launch_context, described[1], timeout=0.05)

    def check(said):
        assert said.splitlines() == ["err"]

    @pytest.mark.launch(fixture=described)
    def test_generator(described, order, launch_context):
        order.append("generator " + described[2])
        tools.assert_stderr_sync(launch_context, described[1], check, timeout=20)
        with pytest.raises(AssertionError, match="err"):
            tools.assert_output_sync(launch_context, described[1], check, timeout=0.05)
        yield
        order.append("its rest " + described[2])

    def test_order(order):
        parts = ("coroutine", "generator", "after", "its rest")
        assert order == [f"{part} {launch}" for launch in "ab" for part in parts]
    """

BAD = """
    import launch_pytest, pytest
    from launch import LaunchDescription
    from launch.actions import RegisterEventHandler, Shutdown
    from launch.event_handlers import OnProcessExit

    @launch_pytest.fixture
    def wrong():
        return 3

    @launch_pytest.fixture
    def early():
        never = OnProcessExit(on_exit=[launch_pytest.actions.ReadyToTest()])
        return LaunchDescription([RegisterEventHandler(never), Shutdown()])

    @launch_pytest.fixture
    def empty():
        return LaunchDescription([])

    @pytest.mark.launch(fixture=wrong)
    def test_wrong(): pass

    @pytest.mark.launch(fixture=early)
    def test_early(): pass

    @pytest.mark.launch(fixture=empty)
    async def test_twice():
        yield
        yield

    @pytest.mark.launch(fixture=empty, shutdown=True)
    def test_shutdown():
        yield

    @pytest.mark.launch
    def test_without(): pass

    @pytest.mark.launch(fixture=empty)
    def test_fails(): assert 1 == 2
    """


def run(project: pytest.Pytester) -> pytest.RunResult:
    """Run the tests of a project in a process of its own."""
    return project.runpytest_subprocess("-p", "no:cacheprovider", "-p", "no:xdist", "--strict-markers")


@pytest.mark.processes
def test_tests_run_beside_a_launch_and_after_it(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(test_good=GOOD)
    run(pytester).assert_outcomes(passed=9)


@pytest.mark.processes
def test_mistakes_are_told(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(test_bad=BAD)
    result = run(pytester)
    result.assert_outcomes(errors=2, failed=3, skipped=1, warnings=1)
    result.stdout.fnmatch_lines_random(
        [
            "*'wrong' must be either a launch description, or a sequence that begins with one: it returned int*",
            "*the launch of the fixture 'early' has ended before its ReadyToTest action*",
            "*must stop iteration after yielding once*",
            "*a generator or async generator is a launch test without shutdown=True*",
            '*"fixture" keyword argument is required in pytest.mark.launch(): there is none*',
            "E*assert 1 == 2",
        ]
    )
