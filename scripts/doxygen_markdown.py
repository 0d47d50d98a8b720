#!/usr/bin/env python3
"""Doxygen's input filter for our Markdown: sections get the names that GitHub gives them, and links find them.

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


def filtered(path):
    page = page_of(path)

    def link(match):
        target, section = match.groups()
        return f"](#{page_of(target) if target else page}-{section})"

    in_code = False
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            if line.startswith("```"):
                in_code = not in_code
            if not in_code:
                # Doxygen knows no bold within a word.
                line = re.sub(r"\*\*(\w+)\*\*(?=\w)", r"<b>\1</b>", line)
                line = re.sub(r"\]\(([\w./-]*\.md)?#([\w-]+)\)", link, line)
                heading = re.match(r"(#{2,6}) (.*)", line)
                if heading:
                    line = f"{line.rstrip()} {{#{page}-{slug(heading[2])}}}\n"
            sys.stdout.write(line)


filtered(sys.argv[1])
