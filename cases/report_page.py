"""Pages that stand alone: text, tables and pictures in one HTML file."""

import base64
import html
import os
import re

STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff;
  max-width: 68rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.6rem; line-height: 1.2; margin: .5rem 0; }
h2 { font-size: 1.2rem; margin: 2rem 0 .5rem; border-bottom: 1px solid #ccc; }
h3 { font-size: 1rem; margin: 1.2rem 0 .3rem; }
p.state { margin: .2rem 0 1rem; color: #444; }
ul.warnings, div.warnings { background: #fff4d6; border-left: 4px solid #e0a800;
  padding: .6rem 1.6rem; }
p.failed { background: #fde2e2; border-left: 4px solid #c00; padding: .6rem 1rem; }
dl.facts { display: grid; grid-template-columns: repeat(auto-fill, minmax(11rem, 1fr));
  gap: .6rem; margin: 1rem 0; }
dl.facts div { border: 1px solid #ddd; border-radius: 4px; padding: .4rem .7rem; }
dl.facts dt { font-size: .8rem; color: #555; }
dl.facts dd { margin: 0; font-size: 1.15rem; font-weight: 600; }
figure { margin: 1rem 0; overflow-x: auto; }
figure img { max-width: 100%; height: auto; display: block; }
@media (max-width: 40rem) { figure > img, figure > svg { min-width: 40rem; }
  div.pair figure > img { min-width: 0; } }
figcaption { font-size: .85rem; color: #555; max-width: 55rem; }
div.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(18rem, 1fr)); gap: 1rem; }
div.charts { display: grid; gap: .5rem 1.2rem;
  grid-template-columns: repeat(auto-fit, minmax(min(100%, 25rem), 1fr)); }
div.charts figure { margin: .5rem 0; } div.charts svg { width: 100%; }
p.note { font-size: .85rem; color: #555; max-width: 55rem; }
div.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .88rem; }
th, td { text-align: left; padding: .15rem .8rem .15rem 0; border-bottom: 1px solid #eee;
  vertical-align: top; }
td.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
tr.failed { color: #b2182b; } figure svg { max-width: 100%; height: auto; }
summary { cursor: pointer; font-weight: 600; margin: 1rem 0 .4rem; }
pre { font-size: .8rem; overflow-x: auto; background: #f6f6f6; padding: .6rem; }
@media print { body { max-width: none; font-size: 10pt; padding: 0; }
  figure, tr, dl.facts div { break-inside: avoid; } h2, h3 { break-after: avoid; }
  div.charts { display: block; } div.charts figure { display: inline-block; width: 48%;
    margin-right: 1%; vertical-align: top; }
  div.wide, pre { overflow: visible; } pre { white-space: pre-wrap; }
  table { font-size: 7.5pt; } th, td { padding-right: 6pt; } th { overflow-wrap: break-word; }
  div.many { page: broad; } div.many table { font-size: 5.5pt; } div.many th, div.many td {
    padding-right: 3pt; } }
@page broad { size: A4 landscape; margin: 8mm; }
"""

MANY = 12  # columns that a printed page upright does not hold
PERCENT = {"strain_at_peak", "shortening", "critical_shortening"}


def with_unit(name, value, unit):
    """A result in the unit that its size calls for, three or four digits."""
    if value is None:
        return "lost"
    if unit == "N m":
        return with_prefix(value, "N m per metre")
    if unit == "Pa":
        for factor, prefix in ((1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa")):
            if abs(value) >= factor:
                return f"{value / factor:.4g} {prefix}"
        return f"{value:.4g} Pa"
    if name in PERCENT:
        return f"{100. * value:.4g} %"
    if unit == "-":
        return f"{value:.0f}" if float(value).is_integer() else f"{value:.4g}"
    return f"{value:.4g}°" if unit == "deg" else f"{value:.4g} {unit}"


def with_prefix(x, unit):
    for factor, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if abs(x) >= factor:
            return f"{x / factor:.4g} {prefix}{unit}"
    return f"{x:.4g} {unit}"


def counted(n, what):
    return f"{n:,} {what}" + ("" if n == 1 else "s")


class Page:
    """The page as it grows. Pictures are drawn into a directory that is thrown away."""

    def __init__(self, scratch):
        self.scratch = scratch
        self.parts = []

    def add(self, text):
        self.parts.append(text)

    def picture(self, path, caption):
        """The picture at @p path, if it was drawn."""
        if not os.path.exists(path):
            return
        kind = "svg+xml" if path.endswith(".svg") else "webp"
        with open(path, "rb") as data:
            code = base64.b64encode(data.read()).decode("ascii")
        self.add(f'<figure><img alt="{html.escape(caption, quote=True)}" '
                 f'src="data:image/{kind};base64,{code}">'
                 f"<figcaption>{html.escape(caption)}</figcaption></figure>")

    def vectors(self, svg, caption):
        """A chart as part of the page, from the text of an SVG file."""
        self.add(f"<figure>{svg[svg.index('<svg'):]}<figcaption>{html.escape(caption)}"
                 "</figcaption></figure>")

    def table(self, head, rows, numbers=True, classes=None):
        """@p rows of text, each of one of @p classes; with @p numbers what begins with a digit
        or a sign is one."""
        def cell(text):
            is_number = numbers and re.match(r"[-+]?\d", text)
            return f'<td{" class=number" if is_number else ""}>{html.escape(text)}</td>'
        many = " many" if len(head) > MANY else ""
        self.add(f'<div class="wide{many}"><table><thead><tr>'
                 + "".join(f"<th>{html.escape(name)}</th>" for name in head) + "</tr></thead>"
                 + "".join(f'<tr class="{kind}">' + "".join(map(cell, row)) + "</tr>"
                           for kind, row in zip(classes or [""] * len(rows), rows))
                 + "</table></div>")

    def path(self, name):
        return os.path.join(self.scratch, name)


def write(page, path):
    text = ("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
            '<meta name="viewport" content="width=device-width, initial-scale=1">'
            '<link rel="icon" href="data:,">'
            f"<title>{html.escape(page.title)}</title><style>{STYLE}</style></head><body>\n"
            + "\n".join(page.parts) + "\n</body></html>\n")
    unfinished = path + ".tmp"
    with open(unfinished, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
    os.replace(unfinished, path)
