#!/usr/bin/env python3
"""Doxygen's input filter for our Markdown: sections get the names that GitHub gives them, links find them, and formulas
($…$ and ```math blocks) become Doxygen's.

Doxygen's section names are global, so each is preceded by the name of its file: `view.md#the-build` is `view-the-build`.
"""
import os
import re
import sys


def slug(title):
    """GitHub's name of a heading."""
    text = re.sub(r"[^\w\- ]", "", title.strip().lower())
    return text.replace(" ", "-")


def page_of(path):
    return os.path.splitext(os.path.basename(path))[0].lower()


def formulas(line):
    """Replaces $…$ outside of code spans."""
    parts = line.split("`")
    parts[::2] = [re.sub(r"\$([^$\s](?:[^$]*[^$\s])?)\$", r"\\f$\1\\f$", part) for part in parts[::2]]
    return "`".join(parts)


def filtered(path):
    page = page_of(path)

    def link(match):
        target, section = match.groups()
        return f"](#{page_of(target) if target else page}-{section})"

    in_code = in_math = False
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            if line.startswith("```math"):
                in_math = True
                line = "\\f[\n"
            elif in_math and line.startswith("```"):
                in_math = False
                sys.stdout.write("\\f]\n")
                continue
            elif line.startswith("```"):
                in_code = not in_code
            if in_math:
                sys.stdout.write(line)
                continue
            if not in_code:
                # Doxygen knows no bold within a word.
                line = re.sub(r"\*\*(\w+)\*\*(?=\w)", r"<b>\1</b>", line)
                line = re.sub(r"\]\(([\w./-]*\.md)?#([\w-]+)\)", link, line)
                line = formulas(line)
                heading = re.match(r"(#{2,6}) (.*)", line)
                if heading:
                    line = f"{line.rstrip()} {{#{page}-{slug(heading[2])}}}\n"
            sys.stdout.write(line)


filtered(sys.argv[1])
