#!/usr/bin/env python3
"""What `antiform check` predicts of decks beside what they take, as a table.

    /usr/bin/python3 cases/cost_check.py                      # decks below a minute
    /usr/bin/python3 cases/cost_check.py --most 1800          # all of them
    /usr/bin/python3 cases/cost_check.py cases/laboratory/uniaxial.prm \\
        --set "Walls/Loading=event driver"

Every deck is run once on one thread, into a directory that is thrown away, with no
packing kept from before; a deck with a section Study member by member, one at once.
Seconds are those of the processor, of the whole process, so that other programs on the
machine disturb them least. The prediction is the mean of one before and one after the
run. Rows further apart than a factor of two are marked.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

CASES = pathlib.Path(__file__).resolve().parent


def decks_of_cases():
    """All decks that are run: no rocks, no parts of decks, no calibrations."""
    decks = []
    for deck in sorted(CASES.glob('*/*.prm')):
        text = deck.read_text()
        is_scene = 'set Components' in text or 'subsection Study' in text
        if deck.parent.name != 'rocks' and is_scene and 'calibration' not in text:
            decks.append(deck)
    return decks


def environment(folder):
    quiet = {'OMP_NUM_THREADS': '1', 'OPENBLAS_NUM_THREADS': '1', 'ANTIFORM_CACHE': 'off'}
    return {**os.environ, **quiet, 'TMPDIR': folder}


def predict(program, deck, overrides, folder):
    command = [program, 'check', str(deck), '--json', '--threads', '1', *overrides]
    done = subprocess.run(command, capture_output=True, text=True,
                          env=environment(folder), check=False)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return json.loads(done.stdout)['prediction']


def stay_on_one_core():
    """A study gives each member its share of the cores; of one, it is one thread."""
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def seconds_and_bytes(command, folder):
    """Of the processor, and the largest memory, of one program and those it starts."""
    with open(os.path.join(folder, 'out'), 'w', encoding='utf-8') as out:
        process = subprocess.Popen(command, stdout=out, stderr=out,
                                   env=environment(folder),
                                   preexec_fn=stay_on_one_core)
        _, status, usage = os.wait4(process.pid, 0)  # with what a study has started
    status = os.waitstatus_to_exitcode(status)
    if status not in (0, 2):  # 2: a strut loaded beyond its strength ends so
        print(pathlib.Path(folder, 'out').read_text(encoding='utf-8'), file=sys.stderr)
        sys.exit(f'{" ".join(command)}: exit status {status}')
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024


def whole(prediction):
    """Of all members, where there are some."""
    return prediction.get('study', prediction)


def seconds_of(prediction):
    return whole(prediction)['core_seconds']


def row(name, figures):
    cells = []
    is_out = False
    for predicted, measured, form in figures:
        ratio = predicted / measured
        is_out |= not 0.5 < ratio < 2.
        cells += [form % predicted, form % measured, '%.2f' % ratio]
    return f'| {name} | ' + ' | '.join(cells) + (' | **out** |' if is_out else ' | |')


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('decks', nargs='*', help='all of cases/ without any')
    parser.add_argument('--set', action='append', default=[], metavar='ENTRY=VALUE')
    parser.add_argument('--most', type=float, default=60.,
                        help='skip decks predicted to take more seconds (60)')
    parser.add_argument('--program', default=str(CASES.parent / 'build' / 'antiform'))
    options = parser.parse_args()
    overrides = [word for text in options.set for word in ('--set', text)]
    print('| deck | s predicted | s measured | ratio | MB predicted | MB measured | '
          'ratio | |\n| --- | --- | --- | --- | --- | --- | --- | --- |')
    for deck in map(pathlib.Path, options.decks or decks_of_cases()):
        with tempfile.TemporaryDirectory() as folder:
            before = predict(options.program, deck, overrides, folder)
            study = 'study' in before
            name = '/'.join(deck.parts[-2:]) + ''.join(
                ', ' + text.split('/')[-1] for text in options.set)
            if seconds_of(before) > options.most:
                print(f'{name}: skipped, {seconds_of(before):.0f} s predicted',
                      file=sys.stderr)
                continue
            command = [options.program, 'study' if study else 'run', str(deck), '-o',
                       os.path.join(folder, 'run'), *overrides]
            command += ['--jobs', '1'] if study else ['--threads', '1']
            seconds, memory = seconds_and_bytes(command, folder)
            after = predict(options.program, deck, overrides, folder)
            figures = [(0.5 * (seconds_of(before) + seconds_of(after)), seconds, '%.3g')]
            figures.append((1e-6 * whole(before)['memory_bytes'], 1e-6 * memory, '%.0f'))
            print(row(name, figures), flush=True)


if __name__ == '__main__':
    main()
