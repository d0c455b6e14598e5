"""What the record of accuracy says of a run, for its page."""
import html


def add_accuracy(page, accuracy, cpu_seconds):
    """@p accuracy: of summary.json; nothing of a run that wanted none."""
    if not accuracy:
        return
    page.add("<h2>Accuracy</h2>")
    page.add(f"<p>{accuracy['wanted_percent']:g} % wanted. By the record (docs/accuracy.md) "
             f"the settings are off by {accuracy['sum_percent']:.2g} % together at most"
             + (", but for what no error is known of." if accuracy["warnings"] else ".")
             + ("" if accuracy["packing_scatter_percent"] is None else
                f" One packing's peak is off the mean of many by "
                f"{accuracy['packing_scatter_percent']:.2g} % besides.") + "</p>")
    if accuracy["warnings"]:
        page.add('<ul class="warnings">' + "".join(
            f"<li>{html.escape(text)}</li>" for text in accuracy["warnings"]) + "</ul>")
    page.table(("entry", "value", "by", "error", "of", "against"),
               [(s["entry"], s["value"], "the record" if s["chosen"]
                 else "the deck" if s["given"] else "default",
                 "not known" if s["error_percent"] is None
                 else f"{s['error_percent']:.2g} %", s["of"], s["truth"])
                for s in accuracy["settings"]], numbers=False)
    if not accuracy["alternatives"]:
        return
    page.add("<h3>What another error takes</h3>")
    entries = [s["entry"] for s in accuracy["settings"]]
    rows = []
    for other in accuracy["alternatives"]:
        row = [f"{other['wanted_percent']:g} %"]
        row += [other["values"].get(entry, "") for entry in entries]
        row.append(f"{other['relative_seconds'] * cpu_seconds:.2g} s" if other["values"]
                   else "not in the record")
        rows.append(row)
    page.table(["error wanted", *entries, "processor time, about"], rows)
