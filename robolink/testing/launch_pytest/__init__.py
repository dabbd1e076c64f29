"""launch_pytest: tests of pytest beside a launch of their own, which a fixture describes.

    @launch_pytest.fixture
    def description():
        return LaunchDescription([ExecuteProcess(cmd=["echo", "hello"], cached_output=True)])

    @pytest.mark.launch(fixture=description)
    async def test_it(launch_context): ...

robolink's plugin of pytest loads `plugin` in a file that uses this.
"""

from __future__ import annotations

from robolink.launch.ros.launch_testing import actions
from robolink.testing.launch_pytest import tools
from robolink.testing.launch_pytest.fixtures import fixture

__all__ = ["actions", "fixture", "tools"]
