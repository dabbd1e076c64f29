"""Loader of node files: a Node class, a function such as `main()`, or a script to run; and the node of a class."""

from __future__ import annotations

import builtins
import importlib.util
import sys
from collections.abc import Callable
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import FunctionType, ModuleType
from typing import TYPE_CHECKING, Any, TypeAlias

from robolink.exceptions import NotFoundError, RobolinkError, nearest
from robolink.system.files import LONGEST_SOURCE, read_plain
from robolink.workspace.find import workspace_of
from robolink.workspace.interfaces import use_interfaces
from robolink.workspace.packages import import_roots, source_packages
from robolink.workspace.source import NodeSource

if TYPE_CHECKING:
    import ast

    from robolink.node import Node

    Runnable: TypeAlias = "type[Node] | Callable[[], Any]"
    ScriptMaker: TypeAlias = "Callable[[NodeSource, Callable[[], None]], Callable[[], Any]]"


RUNNING = frozenset(["init", "spin", "spin_once", "spin_until_future_complete", "create_node"])
"""Names of the functions that a file calls if it runs nodes while it is read."""

NODE_BASES = ("Node", "ScanController", "ImageController")
"""Suffixes of the names of base classes of nodes: Node, LifecycleNode, and those that the library derives from them."""


class NodeLoadError(RobolinkError, ImportError):
    """A file holds no node, or none that can be chosen, or is not Python."""


def load_node(source: NodeSource, *, script: ScriptMaker | None = None) -> Runnable:
    """Return the runnable of a node: a subclass of `Node` to construct and spin, or a function to call.

    The content of a file is decided in this order: the requested attribute; a script, with a `__main__` guard or with
    statements that run a node as the file is read, which is run as Python runs it; a function `main`; its only Node
    class; a script without any of these, which is run too, whatever other classes it has.

    Args:
        source: Source of the node, as `find_node` returns it.
        script: Factory of the function that runs a script, from its source and a function that must be called first so
            that the script's imports are found; by default it is run as Python does.

    Raises:
        NodeLoadError: if the file has no node, or several, or is not Python.
        NotFoundError: if it lacks the attribute. Whatever the file itself raises is raised as it is.
    """
    if source.module and not source.path.is_file():
        near = nearest(source.path.name, (each.name for each in source.path.parent.glob("*.py")))
        raise NodeLoadError(f"{source.name} is {source.module}, says its package, but there is no {source.path}{near}")
    path, tree = source.path, _parse(source.path)
    if not tree.body and not source.module:
        raise NodeLoadError(f"{path} holds no program: is it saved?")
    source = _in_package(source, path, tree)
    if source.attribute:
        return _attribute(_loaded(source), source)
    if _is_script(tree):
        if script is not None:
            return script(source, lambda: _reach_all(source))
        return _script(source, path)
    module = _loaded(source)
    if _defines(tree, "FunctionDef", "main"):
        main: Runnable = module.main
        return main
    if _does_something(tree) and not _own_nodes(module):  # its classes could have been nodes, by their bases
        return lambda: None
    return _only_node(module, path)


def _in_package(source: NodeSource, path: Path, tree: ast.Module) -> NodeSource:
    """Return the source of the file `path` as a module of the package around it if its imports need that, as `from .x`.

    Launchers name a package's files by their paths, and Python refuses relative imports in a file without a package.
    """
    import ast

    is_relative = any(isinstance(each, ast.ImportFrom) and each.level for each in ast.walk(tree))
    if source.module or not is_relative:
        return source
    root = _above_package(path.parent)
    root = root if root != path.parent else path.parent.parent  # a package without an __init__.py
    names = [*path.parent.relative_to(root).parts, *([path.stem] if path.stem != "__init__" else [])]
    return source._replace(module=".".join(names), root=root)


def own_process_needed(source: NodeSource) -> str:
    """Return why the node of `source` cannot share a process, without running its file; '' if nothing shows.

    Only a Node class can: a `main()` or a script makes and spins its nodes itself. Raises `NodeLoadError`.
    """
    tree = _parse(source.path)
    if source.attribute:
        is_program, what = _defines(tree, "FunctionDef", source.attribute), f"a function ({source.attribute})"
    else:
        has_main = _defines(tree, "FunctionDef", "main")
        is_program, what = has_main or _is_script(tree), "a main()" if has_main else "a script"
    if not is_program:
        return ""
    instead = " or ".join(f"{source.path.name}:{each}" for each in _node_classes(tree))
    advice = f"name its class, {instead}, or " if instead else ""
    return f"{source.path.name} is run by {what}, which needs a process of its own: {advice}leave `process` out"


def load_module(path: Path) -> ModuleType:
    """Load the Python file at `path` as a module, named by its whole path; return the same one the second time.

    Its folder is appended to `sys.path`, so that it finds its neighbours, and the types of its workspace can be
    imported. Raises `NodeLoadError` for a file that is not Python, and whatever the file itself raises.
    """
    path = path.resolve()
    name = str(path)
    if name in sys.modules:
        return sys.modules[name]
    _parse(path)
    _reach(path.parent)
    spec = importlib.util.spec_from_loader(name, SourceFileLoader(name, name))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # msgspec looks here for what annotations mean
    # Pickle imports a module's name, and `import a.b` gives the module a: so a path up to its first dot is one, too.
    sys.modules.setdefault(name.partition(".")[0], module)
    try:
        spec.loader.exec_module(module)
    except BaseException:
        for each in [each for each, found in sys.modules.items() if found is module]:
            del sys.modules[each]
        raise
    return module


def _loaded(source: NodeSource) -> ModuleType:
    """Return the module of a node: one of a package by its name, any other file by its path."""
    if not source.module or source.root is None:
        return load_module(source.path)
    _reach_all(source)
    return importlib.import_module(source.module)


def _forget_others(top: str, root: Path) -> None:
    """Remove the modules of a package `top` of another workspace, which this process has imported before."""
    known = sys.modules.get(top)
    if known is None or str(root / top) in map(str, getattr(known, "__path__", [root / top])):
        return
    for name in [each for each in sys.modules if each == top or each.startswith(f"{top}.")]:
        del sys.modules[name]


def _parse(path: Path) -> ast.Module:
    """Parse a file without running it; a mistake becomes one line with its place."""
    import ast

    try:
        source = read_plain(path, LONGEST_SOURCE)
        if source.startswith((b"\xff\xfe", b"\xfe\xff")):  # as PowerShell's > writes it
            raise NodeLoadError(f"{path} is in UTF-16: save it in UTF-8")
        return ast.parse(source, str(path))
    except SyntaxError as error:
        place = f"{path}:{error.lineno or 1}:{error.offset or 1}"
        raise NodeLoadError(f"{place}: {error.msg}") from None
    except OSError as error:
        raise NodeLoadError(f"{path}: cannot be read: {error.strerror}") from None
    except (ValueError, RecursionError, MemoryError) as error:
        raise NodeLoadError(f"{path}: cannot be read: {str(error) or 'it nests too deep'}") from None


def _is_script(tree: ast.Module) -> bool:
    """True if a file is run as Python runs it, and not read for its definitions."""
    if _has_guard(tree) or _acts(tree):
        return True
    if _defines(tree, "FunctionDef", "main"):
        return False
    return not _defines(tree, "ClassDef") or (_does_something(tree) and not _may_define_nodes(tree))


def _has_guard(tree: ast.Module) -> bool:
    """True if there is an `if __name__ == "__main__":`."""
    import ast

    return any(isinstance(each, ast.If) and "__main__" in ast.unparse(each.test) for each in tree.body)


def _acts(tree: ast.Module) -> bool:
    """True if statements outside of functions and classes make or spin nodes, or call a function of the file."""
    import ast

    own = {each.name for each in tree.body if isinstance(each, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef))}
    for statement in tree.body:
        if isinstance(statement, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            continue
        called = {_last_name(each.func) for each in ast.walk(statement) if isinstance(each, ast.Call)}
        if called & RUNNING or (isinstance(statement, ast.Expr) and called & own):
            return True
    return False


def _does_something(tree: ast.Module) -> bool:
    """True if statements outside of functions and classes call something, but for values of names: these prepare."""
    import ast

    acting = (ast.Expr, ast.If, ast.For, ast.While, ast.With, ast.Try)
    own = {each.name for each in tree.body if isinstance(each, ast.ClassDef)}
    for statement in tree.body:
        called = {_last_name(each.func) for each in ast.walk(statement) if isinstance(each, ast.Call)}
        if called and (isinstance(statement, acting) or (isinstance(statement, ast.Assign) and called & own)):
            return True
    return False


def _may_define_nodes(tree: ast.Module) -> bool:
    """True if a class of a file may be a node: one of its bases is neither Python's nor a class that cannot be one."""
    import ast

    harmless = set(vars(builtins))
    for each in tree.body:
        if isinstance(each, ast.ImportFrom) and each.module and _is_pythons(each.module):
            harmless |= {name.asname or name.name for name in each.names}
        elif isinstance(each, ast.Import):
            harmless |= {name.asname or name.name for name in each.names if _is_pythons(name.name)}
        elif isinstance(each, ast.ClassDef):
            if not {ast.unparse(base).partition(".")[0].partition("[")[0] for base in each.bases} <= harmless:
                return True
            harmless.add(each.name)
    return False


def _is_pythons(module: str) -> bool:
    return module.partition(".")[0] in sys.stdlib_module_names


def _defines(tree: ast.Module, kind: str, name: str | None = None) -> bool:
    return any(type(each).__name__ == kind and name in (None, getattr(each, "name", "")) for each in tree.body)


def _node_classes(tree: ast.Module) -> list[str]:
    """Return the classes of a file that are nodes by their bases, without those that others of them extend."""
    import ast

    found: dict[str, set[str]] = {}
    for each in tree.body:
        if isinstance(each, ast.ClassDef):
            bases = {_last_name(base) for base in each.bases}
            if bases & found.keys() or any(base.endswith(NODE_BASES) for base in bases):
                found[each.name] = bases
    extended = set().union(*found.values())
    return [name for name in found if name not in extended]


def _last_name(named: ast.expr) -> str:
    """Return the last name of a base or a function: `rclpy.node.Node` is `Node`."""
    return str(getattr(named, "id", getattr(named, "attr", "")))


def _script(source: NodeSource, path: Path) -> Callable[[], Any]:
    """Return a function that runs a file as `python FILE` does, one of a package as `python -m MODULE`."""

    def run() -> None:
        import runpy

        _reach_all(source)
        if source.module and source.root is not None:
            runpy.run_module(source.module, run_name="__main__", alter_sys=True)
        else:
            runpy.run_path(str(path), run_name="__main__")

    return run


def _reach_all(source: NodeSource) -> None:
    if source.module and source.root is not None:
        _forget_others(source.module.partition(".")[0], source.root)
    _reach(source.path.parent, source.root)


def _reach(folder: Path, root: Path | None = None) -> None:
    """Make the imports of a file in this folder possible: its neighbours, its package, and its workspace's.

    The `root` of a package goes first, so that these files are found and not what was once installed of them.
    """
    workspace = workspace_of(folder)
    use_interfaces(workspace)
    if root is not None and str(root) not in sys.path:
        sys.path.insert(0, str(root))
    packages = source_packages(workspace).values() if workspace is not None else ()
    for each in (folder, _above_package(folder), *(root for package in packages for root in import_roots(package))):
        if str(each) not in sys.path:
            sys.path.append(str(each))


def reach_module(top: str, folder: Path) -> None:
    """Make the imports of a package's modules possible, whoever asks for them.

    Args:
        top: First part of the modules' names.
        folder: Folder of the package.
    """
    root = next((each for each in import_roots(folder) if (each / top).is_dir()), folder)
    _forget_others(top, root)
    _reach(root / top, root)


def _above_package(folder: Path) -> Path:
    """Return the folder from which the modules in `folder` are imported with the names of their packages."""
    while (folder / "__init__.py").is_file() and folder != folder.parent:
        folder = folder.parent
    return folder


def _attribute(module: ModuleType, source: NodeSource) -> Runnable:
    if not hasattr(module, source.attribute):
        known = [name for name, value in vars(module).items() if callable(value) and not name.startswith("_")]
        raise NotFoundError("class or function", source.attribute, known, str(source.path))
    return _checked(getattr(module, source.attribute), source.spec)


def _checked(found: Any, spec: str) -> Runnable:
    """Refuse what can neither be constructed as a node nor called."""
    if isinstance(found, type) and not _is_node(found):
        raise NodeLoadError(f"{spec} is a class, but no subclass of Node")
    if not callable(found):
        raise NodeLoadError(f"{spec} is neither a Node class nor a function")
    runnable: Runnable = found
    return runnable


def _only_node(module: ModuleType, path: Path) -> Runnable:
    """Return the only Node class that a module itself defines (one that others of them extend does not count)."""
    own = _own_nodes(module)
    last = [each for each in own if not any(other is not each and issubclass(other, each) for other in own)]
    if not last:
        raise NodeLoadError(f"{path} holds no node: {_lack(module)}")
    if len(last) > 1:
        choices = " or ".join(f"{path.name}:{each.__name__}" for each in last)
        raise NodeLoadError(f"{path} holds {len(last)} nodes: say which, {choices}")
    found: type[Node] = last[0]
    return found


def _own_nodes(module: ModuleType) -> list[type[Node]]:
    return [each for each in vars(module).values() if _is_node(each) and each.__module__ == module.__name__]


def _lack(module: ModuleType) -> str:
    """Return the lack of a module without a node; a class that is none has often only lost its `(Node)`."""
    values = list(vars(module).items())
    plain = [name for name, value in values if type(value) is type and value.__module__ == module.__name__]
    if len(plain) == 1 and any(name == "Node" and isinstance(value, type) for name, value in values):
        return f"the class {plain[0]} is none; write class {plain[0]}(Node):"
    return "no Node class, no main() and no `if __name__ == '__main__'`"


def _is_node(found: object) -> bool:
    from robolink.node import BaseNode, Node

    return isinstance(found, type) and issubclass(found, BaseNode) and found not in (BaseNode, Node)


def runs_itself(node_class: object) -> bool:
    """Return True for a class of AsyncNodes, which no executor spins."""
    return isinstance(node_class, type) and getattr(node_class, "_runs_itself_", False) is True


def make_node(node_class: Callable[[], Node]) -> Node:
    """Return a new node. Raises NodeLoadError for a class that needs arguments, or does not construct its base."""
    check_needs_nothing(node_class)
    node = node_class()
    if not hasattr(node, "_owner_"):
        name = type(node).__name__
        raise NodeLoadError(f"{name}.__init__ must call super().__init__('{name.lower()}') before all else")
    return node


def _clearly_needs_nothing(found: Callable[[], Any]) -> bool:
    """True for a function, or a class with an `__init__`, that plainly has no arguments without a default."""
    makes: Any = getattr(found, "__new__", None)
    is_class = isinstance(found, type) and type(found).__call__ is type.__call__ and makes is object.__new__
    plain: Any = found.__init__ if is_class else found
    if not isinstance(plain, FunctionType) or vars(plain).keys() & {"__wrapped__", "__signature__"}:
        return False
    code = plain.__code__
    has_keywords = code.co_kwonlyargcount > len(plain.__kwdefaults__ or {})
    return not has_keywords and code.co_argcount - len(plain.__defaults__ or ()) <= int(is_class)


def check_needs_nothing(found: Callable[[], Any]) -> None:
    """Raise NodeLoadError for a class or function that needs arguments: nobody is there to give them."""
    if _clearly_needs_nothing(found):
        return
    import inspect  # late: it takes 5 ms

    try:
        needed = [
            each.name
            for each in inspect.signature(found).parameters.values()
            if each.default is each.empty and each.kind not in (each.VAR_POSITIONAL, each.VAR_KEYWORD)
        ]
    except (TypeError, ValueError):  # a signature that Python cannot tell
        return
    if needed:
        name, listed = getattr(found, "__name__", str(found)), ", ".join(f"'{each}'" for each in needed)
        if isinstance(found, type) and "__init__" not in vars(found):
            raise NodeLoadError(_without_init(found))
        if isinstance(found, type):
            name, otherwise = f"{name}.__init__", ", or write a main() that makes the node"
        else:
            name, otherwise = f"{name}()", f", as in {name}({needed[0]}=None)"
        raise NodeLoadError(f"{name} needs {listed}: give a default value{otherwise}")


def _without_init(found: type) -> str:
    """Return the fault of a class that has no `__init__` of its own: perhaps a name that is nearly that."""
    near = next((each for each in vars(found) if each.strip("_") in ("init", "int") and each != "__init__"), "")
    meant = f": {near} is to be __init__, with two _ on each side" if near else ", which gives the node its name"
    return f"{found.__name__} has no __init__ of its own{meant}"
