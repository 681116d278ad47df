"""Dependencies point down only, between the files of a crate too: fails where files of one crate depend on each other in a circle.

    python3 .ci/layers.py                 all crates of this workspace
    python3 .ci/layers.py FOLDER..        these crates

A file depends on another where it names what that one defines: by `use`, or by a path that begins with `crate`, `super`, `self`, a
module or an imported module. Names are followed through re-exports to the file that defines the item, and `mod` and `pub use` alone
make no dependency. The file of a module and those of its children count like any others. What `#[cfg(test)]` stands before is left
out. Not followed: methods, which may stand in any file whose type the caller names, macros, and names that a macro makes.
"""

import re
import sys
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|b?r(#*)".*?"\1|b?"(?:\\.|[^"\\])*"|b?\'(?:\\.[^\']*|[^\\\'])\'', re.DOTALL)
TEST = re.compile(r"#\[cfg\(test\)\]\s*(?:#\[[^\n]*\]\s*)*")
USE = re.compile(r"\b(pub(?:\([^)]*\))?\s+)?use\s+([^;]+);")
CHILD = re.compile(r"\bmod\s+(\w+)\s*;")
ITEM = re.compile(r"\b(?:fn|struct|enum|trait|type|union|macro_rules!|const|static(?:\s+mut)?)\s+(?!(?:fn|unsafe|mut)\b)(\w+)")
PATH = re.compile(r"(?<![\w:])(\w+)((?:::\w+)+)")


def without_tests(text):
    """Rust text without comments, strings and what is there for tests alone."""
    text = NOISE.sub('""', text)
    while found := TEST.search(text):
        end, depth = found.end(), 0
        while end < len(text) and not (depth == 0 and text[end - 1] in "};" and end > found.end()):
            depth += (text[end] in "{[(") - (text[end] in "}])")
            end += 1
        text = text[: found.start()] + text[end:]
    return text


def outermost(text):
    """What stands in no braces."""
    kept, depth = [], 0
    for part in re.split(r"([{}])", text):
        depth += {"{": 1, "}": -1}.get(part, 0)
        kept.append(part if depth == 0 else "")
    return " ".join(kept)


def imports(tree, before=()):
    """Each path of a `use`, with the name it gets."""
    tree = tree.strip()
    if tree.startswith("{"):
        depth, start = 0, 1
        for at, sign in enumerate(tree):
            depth += {"{": 1, "}": -1}.get(sign, 0)
            if (sign == "," and depth == 1) or depth == 0:
                yield from imports(tree[start:at], before)
                start = at + 1
    elif "::" in tree.split("{")[0]:
        first, rest = tree.split("::", 1)
        yield from imports(rest, (*before, first.strip()))
    elif tree:
        name, _, alias = tree.partition(" as ")
        path = before if name.strip() == "self" else (*before, name.strip())
        yield path, alias.strip() or path[-1]


class Crate:
    """The files of a crate by their modules, each a tuple of names."""

    def __init__(self, root):
        self.body, self.items, self.names, self.reexported = {}, {}, defaultdict(dict), defaultdict(set)
        self.read(root, (), root.parent)

    def read(self, file, module, folder):
        text = without_tests(file.read_text(encoding="utf-8"))
        for public, tree in USE.findall(text):
            for path, name in imports(tree):
                name = "::".join(path) if name == "*" else name
                self.names[module][name] = path
                if public:
                    self.reexported[module].add(name)
        self.items[module] = set(ITEM.findall(outermost(text)))
        self.body[module] = CHILD.sub("", USE.sub("", text))
        for child in CHILD.findall(text):
            inner = folder / child / "mod.rs"
            self.read(inner if inner.exists() else folder / f"{child}.rs", (*module, child), folder / child)

    def absolute(self, module, path):
        """A path as from the crate's root; `None` of another crate's."""
        up = 0
        while up < len(path) and path[up] == "super":
            up += 1
        if up:
            return module[: len(module) - up] + path[up:]
        if path[0] in ("crate", "self"):
            return (() if path[0] == "crate" else module) + path[1:]
        return module + path if (*module, path[0]) in self.body else None

    def definition(self, path, depth=0):
        """The module whose file defines the item at a path from the root; `None` where a module is all that stands there."""
        at = max((end for end in range(len(path)) if path[:end] in self.body), default=None)
        if at is None or depth > 20:
            return None
        module, (name, *rest) = path[:at], path[at:]
        if name in self.items[module]:
            return module
        reexports = [self.names[module][name]] if name in self.names[module] else []
        globs = [(*path[:-1], name) for path in self.names[module].values() if path[-1] == "*"]
        for outer in (*reexports, *globs):
            inner = self.inside(module, outer)
            if inner is not None and (found := self.definition((*inner, *rest), depth + 1)) is not None:
                return found
        return None

    def inside(self, module, path):
        """As `absolute`, where the path may begin with a name that is imported."""
        names, found = self.names[module], self.absolute(module, path)
        if found is None and path[0] in names and names[path[0]][0] != path[0]:
            outer = self.absolute(module, names[path[0]])
            return None if outer is None else outer + path[1:]
        return found

    def dependencies(self, module):
        """The modules that one names, with what it names of each."""
        body, found = self.body[module], defaultdict(set)
        named = [(first, *rest.split("::")[1:]) for first, rest in PATH.findall(body)]
        for name, path in self.names[module].items():
            # A re-export counts where its file uses it itself; fields and methods may have its name too.
            if name not in self.reexported[module] or re.search(rf"(?<![.\w]){re.escape(name)}\b(?!\s*:[^:])", body):
                named.append(path)
        for path in named:
            glob = path[-1] == "*"
            inner = self.inside(module, path[:-1] if glob else path)
            target = None if inner is None else inner if glob else self.definition(inner)
            if target not in (None, module):
                found[target].add("::".join(part for part in path if part not in ("crate", "self", "super")))
        return found


def circles(edges):
    """Shortest circles that share no file, each a list of files."""
    edges = {file: set(others) for file, others in edges.items()}
    while True:
        found = [circle for file in sorted(edges) if (circle := shortest(edges, file))]
        if not found:
            return
        circle = min(found, key=len)
        yield circle
        for file in circle:
            del edges[file]


def shortest(edges, start):
    """The shortest way from a file back to itself; `None` where there is none."""
    ways, seen = [[start]], set()
    for way in ways:
        for other in sorted(edges[way[-1]]):
            if other == start:
                return way
            if other in edges and other not in seen:
                seen.add(other)
                ways.append([*way, other])
    return None


def check(folder):
    """Prints the circles of a crate, and tells how many there are."""
    crate, count = Crate(folder / "src" / "lib.rs"), 0
    edges = {module: crate.dependencies(module) for module in crate.body}
    for circle in circles(edges):
        count += 1
        print(f"{folder.name}: a circle of {len(circle)} files")
        for file, other in zip(circle, circle[1:] + circle[:1]):
            print(f"    {'::'.join(file) or 'lib'} -> {'::'.join(other) or 'lib'}: {', '.join(sorted(edges[file][other]))}")
    return count


if __name__ == "__main__":
    folders = [Path(folder) for folder in sys.argv[1:]] or sorted(path.parent for path in ROOT.glob("crates/*/Cargo.toml"))
    if sum(map(check, folders)):
        sys.exit("move what stands in the wrong file, or what both need into a file below both")
