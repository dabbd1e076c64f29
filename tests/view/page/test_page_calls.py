"""Panels that call nodes: services with their forms, parameters, and actions."""

from __future__ import annotations

import json
import threading
from pathlib import Path
from typing import Any

import pytest

from robolink.action import ActionServer, CancelResponse, GoalResponse
from robolink.bag.reader import open_bag
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.executors import MultiThreadedExecutor
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from robolink.interfaces.rcl_interfaces.srv import SetParameters
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.node import Node
from robolink.parameter import Parameter
from robolink.view.server import Settings, View
from robolink.view.sources.bag import BagSource
from tests.support.bags import ten_messages
from tests.support.bags import write as write_bag
from tests.support.browser import Browser, needs_chromium
from tests.support.pages import Page, opened
from tests.support.view_clients import WITHIN, until

SCHEMA = "byte LOW=1\nbyte HIGH=2\nbyte level 2\nstring<=3 name\nbool[2] flags\nint32[] empty\n"
"""A type with constants, bounds and arrays."""

pytestmark = [pytest.mark.processes, needs_chromium]


def text(page: Page, selector: str, wanted: str) -> None:
    """Wait until an element's text has a part."""
    page.browser.wait(f"document.querySelector({json.dumps(selector)})?.textContent.includes({json.dumps(wanted)})")


def write(page: Page, selector: str, what: str) -> None:
    """Type into a field instead of what is there."""
    page.browser.click(selector, count=3)
    page.browser.js(f"document.querySelector({json.dumps(selector)}).select()")
    page.browser.type(what)


class TestServices:
    """The services panel."""

    def test_a_service_is_called_with_a_form_and_its_answer_shown(self, browser: Browser) -> None:
        def light(request: Any, response: Any) -> Any:
            response.success, response.message = request.data, f"light is {'on' if request.data else 'off'}"
            return response

        with opened(browser, "services") as page, page.system.spinning() as node:
            node.create_service(SetBool, "light", light)
            browser.choose(".panel-services .picker", "/light")
            browser.click("[data-field=data]")
            browser.click("button.call")
            text(page, ".panel-services .tree", "light is on")
            text(page, ".panel-services .state", "answered in")
            page.picture("services")

    def test_a_form_has_lists_constants_and_ranges_and_tells_what_does_not_fit(self, browser: Browser) -> None:
        heard: list[Any] = []

        def take(request: Any, response: Any) -> Any:
            heard.append(request)
            return response

        with opened(browser, "services") as page, page.system.spinning() as node:
            node.create_service(SetParameters, "settings", take)
            browser.choose(".panel-services .picker", "/settings")
            browser.click("[data-add=parameters]")
            write(page, "[data-field='parameters[0].name']", "speed")
            write(page, "[data-field='parameters[0].value.integer_value']", "1.5")
            browser.click("button.call")
            text(page, ".panel-services .state", "parameters[0].value.integer_value: a number is needed, got '1.5'")
            assert browser.js("document.querySelector('[aria-invalid]').dataset.field").endswith("integer_value")
            write(page, "[data-field='parameters[0].value.integer_value']", "9223372036854775807")
            write(page, "[data-field='parameters[0].value.type']", "300")
            browser.click("button.call")
            text(page, ".panel-services .state", "type: 0 to 255, got '300'")
            page.picture("services_form")
            write(page, "[data-field='parameters[0].value.type']", "2")
            write(page, "[data-field='parameters[0].value.double_array_value']", "1, 2.5, -inf")
            browser.click("button.call")
            until(lambda: bool(heard))
            (got,) = heard[0].parameters
            assert (got.name, got.value.type, got.value.integer_value) == ("speed", 2, 2**63 - 1)
            assert list(got.value.double_array_value) == [1.0, 2.5, float("-inf")]

    def test_constants_are_offered_by_their_names(self, browser: Browser) -> None:
        with opened(browser, "services"):
            made = f"globalThis.form = new Form(new Schema('a/msg/B', {json.dumps(SCHEMA)}), robolink.words)"
            browser.js(
                f"import('/panels/form.js').then(async ({{ Form }}) => {{ const {{ Schema }} = await import('/cdr.js');"
                f" {made};"
                " document.querySelector('.panel-services .scroll').append(form.element); })"
            )
            assert browser.js("document.querySelector('[data-choice=level]').selectedOptions[0].text") == "HIGH (2)"
            browser.choose("[data-choice=level]", "1")
            assert browser.js("form.value") == {"level": 1, "name": "", "flags": [False, False], "empty": []}

    def test_a_failed_call_says_why_and_read_only_says_so(self, browser: Browser) -> None:
        def broken(request: Any, response: Any) -> Any:
            raise ValueError("no lamp")

        with opened(browser, "services", token=False) as page:
            page.node.create_service(SetBool, "light", broken)
            browser.choose(".panel-services .picker", "/light")
            assert browser.js("document.querySelector('button.call').disabled")
            text(page, ".panel-services .state", "without the token")


class TestParameters:
    """The parameters panel."""

    @staticmethod
    def declare(node: Node) -> None:
        node.declare_parameter("name", "r2", ParameterDescriptor(description="what it is called"))
        speed = FloatingPointRange(from_value=0.0, to_value=2.0, step=0.1)
        node.declare_parameter("speed", 1.0, ParameterDescriptor(floating_point_range=[speed]))
        node.declare_parameter(
            "count", 3, ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=10, step=1)])
        )
        node.declare_parameter("serial", 7, ParameterDescriptor(read_only=True))
        node.declare_parameter("on", False)
        node.declare_parameter("gains", [1.0, 2.0])
        node.declare_parameter("names", ["a, b", "c"])

    def test_parameters_are_shown_and_set_by_their_types(self, browser: Browser) -> None:
        with opened(browser, "parameters") as page, page.system.spinning() as node:
            self.declare(node)
            browser.choose(".panel-parameters .picker", "/robot")
            browser.wait("document.querySelector('[data-parameter=gains]')?.value == '1, 2'")
            assert browser.js("document.querySelector('[data-parameter=serial]').disabled")
            assert "what it is called" in browser.js(
                "document.querySelector('[data-parameter=name]').parentNode.parentNode.title"
            )
            write(page, "[data-parameter=name]", "marvin")
            browser.press("Enter")
            until(lambda: bool(node.get_parameter("name").value == "marvin"))
            browser.click("[data-parameter=on]")
            until(lambda: node.get_parameter("on").value is True)
            write(page, "[data-parameter=gains]", "3, 4.5")
            browser.press("Enter")
            until(lambda: list(node.get_parameter("gains").value) == [3.0, 4.5])
            page.picture("parameters")
            browser.click(".panel-parameters input[type=range][aria-label=count]")
            until(lambda: node.get_parameter("count").value == 5)

    def test_a_node_s_reason_is_shown_and_the_value_is_put_back(self, browser: Browser) -> None:
        with opened(browser, "parameters") as page, page.system.spinning() as node:
            self.declare(node)
            node.add_on_set_parameters_callback(
                lambda them: SetParametersResult(successful=them[0].value != "hal", reason="not that name")
            )
            browser.choose(".panel-parameters .picker", "/robot")
            browser.wait("document.querySelector('[data-parameter=name]')")
            write(page, "[data-parameter=name]", "hal")
            browser.press("Enter")
            text(page, ".panel-parameters .state", "name: not that name")
            browser.wait("document.querySelector('[data-parameter=name]').value == 'r2'")
            page.picture("parameters_refused")
            write(page, "[data-parameter=count]", "11")
            browser.press("Enter")
            text(page, ".panel-parameters .state", "count: ")
            browser.wait("document.querySelector('[data-parameter=count]').value == '3'")
            write(page, "[data-parameter=count]", "many")
            browser.press("Enter")
            text(page, ".panel-parameters .state", "a number is needed, got 'many'")

    def test_without_the_token_the_values_are_shown_and_cannot_be_set(self, browser: Browser) -> None:
        with opened(browser, "parameters", token=False) as page, page.system.spinning() as node:
            self.declare(node)
            browser.choose(".panel-parameters .picker", "/robot")
            browser.wait("document.querySelector('[data-parameter=name]')?.value == 'r2'")
            assert browser.js("document.querySelector('[data-parameter=name]').disabled")
            text(page, ".panel-parameters .state", "without the token")

    def test_values_that_others_set_are_followed(self, browser: Browser) -> None:
        with opened(browser, "parameters") as page, page.system.spinning() as node:
            self.declare(node)
            browser.choose(".panel-parameters .picker", "/robot")
            browser.wait("document.querySelector('[data-parameter=speed]')?.value == '1'")
            node.set_parameters([Parameter("speed", value=1.5)])
            browser.wait("document.querySelector('[data-parameter=speed]').value == '1.5'")


class TestActions:
    """The actions panel."""

    @staticmethod
    def serve(node: Node) -> ActionServer:
        def execute(goal: Any) -> Any:
            sequence = [0, 1]
            for _ in range(goal.request.order):
                sequence.append(sequence[-1] + sequence[-2])
                goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
            goal.succeed()
            return Fibonacci.Result(sequence=sequence)

        return ActionServer(
            node,
            Fibonacci,
            "count",
            execute,
            goal_callback=lambda goal: GoalResponse.REJECT if goal.order < 0 else GoalResponse.ACCEPT,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )

    def test_a_goal_is_sent_and_its_result_shown(self, browser: Browser) -> None:
        with opened(browser, "actions") as page, page.system.spinning() as node:
            self.serve(node)
            browser.choose(".panel-actions .picker", "/count")
            write(page, "[data-field=order]", "3")
            browser.click("button.send")
            text(page, ".goal-state", "succeeded")
            text(page, ".goal .tree", "[5] 0, 1, 1, 2, 3")
            text(page, ".goal .feedback", "sequence [5] 0, 1, 1, 2, 3")
            page.picture("actions")
            write(page, "[data-field=order]", "-1")
            browser.click("button.send")
            text(page, ".goal-state", "rejected")

    def test_a_goal_is_canceled(self, browser: Browser) -> None:
        canceled = threading.Event()

        def execute(goal: Any) -> Any:
            assert canceled.wait(WITHIN)
            until(lambda: bool(goal.is_cancel_requested))
            goal.canceled()
            return Fibonacci.Result(sequence=[7])

        def cancel(_: Any) -> CancelResponse:
            canceled.set()
            return CancelResponse.ACCEPT

        with opened(browser, "actions") as page:
            node, executor = page.node, MultiThreadedExecutor(context=page.system.context, num_threads=3)
            group = ReentrantCallbackGroup()
            server = ActionServer(node, Fibonacci, "count", execute, cancel_callback=cancel, callback_group=group)
            executor.add_node(node)
            thread = threading.Thread(target=executor.spin)
            thread.start()
            try:
                browser.choose(".panel-actions .picker", "/count")
                browser.click("button.send")
                text(page, ".goal-state", "executing")
                browser.click(".goal .cancel")
                text(page, ".goal-state", "canceled")
                text(page, ".goal .tree", "[1] 7")
                page.picture("actions_canceled")
            finally:
                canceled.set()
                executor.shutdown()
                thread.join(WITHIN)
                server.destroy()


@pytest.mark.parametrize(
    ("panel", "option", "none"),
    [
        ("services", {"service": "/gone"}, "No node serves anything of its own"),
        ("actions", {"action": "/gone"}, "No node serves an action"),
        ("parameters", {"node": "/gone"}, "/robot"),
    ],
)
def test_what_nobody_serves_is_told(browser: Browser, panel: str, option: dict[str, str], none: str) -> None:
    with opened(browser, panel) as page:
        text(page, f".panel-{panel}", none)
    tab = {"id": panel, "options": option}
    with opened(browser, layout={"columns": [{"width": 50, "cells": [{"tabs": [tab]}]}]}) as page:
        text(page, f".panel-{panel} .state", "Nobody serves /gone now")
        page.picture(f"{panel}_gone")


def test_a_bag_has_nothing_to_call(browser: Browser, tmp_path: Path) -> None:
    write_bag(tmp_path / "bag", ten_messages())
    with (
        open_bag(tmp_path / "bag") as bag,
        View(BagSource(bag), Settings(port=0)) as view,
        opened(browser, "services", "actions", "parameters", "images", view=view) as page,
    ):
        for panel in ("services", "actions", "parameters"):
            text(page, f".panel-{panel} .state", "A bag has messages alone")
        text(page, ".panel-images .empty", "No topic of this bag has images.")


def test_an_action_that_comes_back_is_offered_again(browser: Browser) -> None:
    with opened(browser, "actions") as page, page.system.spinning() as node:
        server = TestActions.serve(node)
        browser.wait("document.querySelector('button.send') && !document.querySelector('button.send').disabled")
        server.destroy()
        text(page, ".panel-actions .state", "Nobody serves /count now")
        assert browser.js("document.querySelector('button.send').disabled")
        TestActions.serve(node)
        browser.wait("!document.querySelector('button.send').disabled")
        browser.wait("document.querySelector('.panel-actions .state').textContent == ''")
