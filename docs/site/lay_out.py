#!/usr/bin/python3
"""Lays out the tree that Sphinx reads: the documents as links to themselves, and the pages that are generated.

usage: lay_out.py ROOT TREE PROGRAM
Links between documents hold as they stand: the tree has the shape of the project. Figures are drawn by the program, from
the commands that docs/gallery.md shows above them.
"""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import cpp_pages


def link_documents(root, tree):
    """Pages as links to themselves; the rest of the project, which pages refer to, as files to download."""
    for path in [*root.glob("*.md"), root / "LICENSE", root / "CITATION.cff", *(root / "docs").rglob("*")]:
        if path.is_file() and "site" not in path.relative_to(root).parts:
            link(path, tree / path.relative_to(root))
    for name in ("devices", "examples", "firmware", "recordings", "include", "packaging"):
        for path in (root / name).rglob("*"):
            if path.is_file() and path.suffix != ".rst":
                link(path, tree / path.relative_to(root))


def link(source, target):
    target.parent.mkdir(parents=True, exist_ok=True)
    target.symlink_to(source)


def command_pages(tree, program):
    folder = tree / "docs/reference/commands"
    folder.mkdir(parents=True)
    commands = re.findall(r"^  ([a-z]+) +[A-Z]", run([program, "--help"]).split("\nCommands:\n")[1], re.M)
    for command in commands:
        text = run([program, command, "--help"])
        (folder / f"{command}.md").write_text(f"# zwidth {command}\n\nWhat `zwidth {command} --help` prints.\n\n```text\n{text.rstrip()}\n```\n")
    listed = "\n".join(commands)
    (folder / "index.md").write_text(
        "# Commands\n\nGenerated from the options themselves. Exit status: 0 done; 1 the work failed; 2 wrong usage or bad input. An answer that is refused is an answer, 0; "
        "a file that it would have filled is work that failed, 1.\n\n"
        f"```{{toctree}}\n{listed}\n```\n"
    )


def figures(root, tree, program):
    """Runs the commands of docs/gallery.md, which write the figures that it shows."""
    text = (root / "docs/gallery.md").read_text()
    folder = tree / "docs/gallery"
    folder.mkdir()
    for command in re.findall(r"^zwidth (.*)$", text.replace("\\\n", ""), re.M):
        words = shlex.split(command)
        place = words.index("--figure" if "--figure" in words else "--output") + 1
        output = words[place]
        words[place] = str(folder / output)
        run([program, *words], cwd=root)
        if f"](gallery/{output})" not in text:
            sys.exit(f"docs/gallery.md shows no gallery/{output}")


def run(words, cwd=None):
    done = subprocess.run(words, capture_output=True, text=True, cwd=cwd, env=dict(os.environ, COLUMNS="100"))
    if done.returncode != 0:
        sys.exit(f"{shlex.join(map(str, words))}: {done.stderr}")
    return done.stdout


def main():
    root, tree, program = Path(sys.argv[1]).resolve(), Path(sys.argv[2]), str(Path(sys.argv[3]).resolve())
    tree.mkdir(parents=True)
    link_documents(root, tree)
    command_pages(tree, program)
    cpp_pages.write(root, tree)
    figures(root, tree, program)


if __name__ == "__main__":
    main()
