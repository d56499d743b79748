#!/usr/bin/env python3
"""Takes the plots out of a page that `ensemble report --html` or `bench --html` wrote, for use elsewhere.

Usage: page_figures.py PAGE.html PREFIX [WORD...]

Writes PREFIX-LABEL.svg for each plot, or for those whose label holds one of the words; each brings its style.
"""
import pathlib
import re
import sys


def main():
    if len(sys.argv) < 3 or sys.argv[1].startswith("-"):
        sys.exit(__doc__.strip())
    page = pathlib.Path(sys.argv[1]).read_text()
    style = re.search(r"<style>(.*?)</style>", page, re.S).group(1)
    found = 0
    for plot in re.findall(r"<svg .*?</svg>", page, re.S):
        label = re.search(r'aria-label="([^"]*)"', plot).group(1)
        if sys.argv[3:] and not any(word in label for word in sys.argv[3:]):
            continue
        name = re.sub(r"[^a-z0-9]+", "-", label.lower()).strip("-")
        end = plot.index(">") + 1
        pathlib.Path(f"{sys.argv[2]}-{name}.svg").write_text(
            f"{plot[:end]}\n<style>{style}\nsvg {{ background: var(--page); }}</style>{plot[end:]}\n")
        found += 1
    if not found:
        sys.exit(f"page_figures.py: {sys.argv[1]}: there is no such plot; see the labels in the page")


if __name__ == "__main__":
    main()
