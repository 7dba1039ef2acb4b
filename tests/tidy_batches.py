#!/usr/bin/env python3
"""clang-tidy over many files at once: tidy_batches.py BUILD_FOLDER FILE...

Most of clang-tidy's time goes into headers that every file includes. So files of one folder are
checked together, as one file that includes them all; where their names clash, by halves of it.
"""
import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys

LARGEST_BATCH = 16
# Files that are compiled for one instruction set each.
ALONE = ("kernels_avx2.cc", "kernels_avx512.cc", "kernels_portable.cc")


def options_of(entry):
    """The compiler's options of an entry of compile_commands.json, without files and launchers."""
    words = shlex.split(entry["command"])
    words = words[next(i for i, word in enumerate(words) if "clang++" in word) + 1 :]
    options = []
    skip = False
    for word, after in zip(words, words[1:] + [""]):
        if skip:
            skip = False
        elif word in ("-isystem", "-I"):
            options.append(word + " " + after)
            skip = True
        elif word in ("-o", "-c", "-MF", "-MT"):
            skip = True
        elif word not in ("-MD", "-c"):
            options.append(word)
    return options


def folders_of(build, files):
    entries = {}
    for entry in json.loads((build / "compile_commands.json").read_text()):
        entries.setdefault(str(pathlib.Path(entry["directory"], entry["file"]).resolve()), entry)
    folders = {}
    for file in files:
        path = str(pathlib.Path(file).resolve())
        if path in entries:
            alone = path if os.path.basename(path) in ALONE else ""
            folders.setdefault((os.path.dirname(path), alone), []).append((path, entries[path]))
        else:
            print(f"{file}: not compiled in {build}", file=sys.stderr)
    return folders.values()


def compiles(entry):
    """Whether the names of the files do not clash. Much quicker than to ask clang-tidy."""
    command = entry["command"].replace(" -Werror", "") + " -fsyntax-only -w"
    run = subprocess.run(["bash", "-c", command], cwd=entry["directory"], capture_output=True,
                         check=False)
    return run.returncode == 0


def check(build, batch, number):
    """Whether the batch is clean, and what was printed."""
    folder = build / "batches" / number
    folder.mkdir(parents=True, exist_ok=True)
    options = list(dict.fromkeys(option for _, entry in batch for option in options_of(entry)))
    together = folder / "batch.cc"
    together.write_text("".join(f'#include "{path}"\n' for path, _ in batch))
    command = " ".join(["clang++", *(shlex.quote(o) if " " not in o else o for o in options)])
    entry = {"directory": batch[0][1]["directory"], "file": str(together)}
    entry["command"] = f"{command} -Wno-unneeded-internal-declaration -c {together}"
    if len(batch) > 1 and not compiles(entry):
        middle = len(batch) // 2
        halves = [check(build, batch[:middle], number + "a"),
                  check(build, batch[middle:], number + "b")]
        return all(clean for clean, _ in halves), "".join(text for _, text in halves)
    (folder / "compile_commands.json").write_text(json.dumps([entry]))
    run = subprocess.run(
        ["clang-tidy", "--quiet", "-p", str(folder), # Findings about the whole that no single file would have.
         "--checks=-bugprone-suspicious-include,-bugprone-forward-declaration-namespace",
         "--header-filter=/(engine|gpu|server|client|proto/wire|tests)/[^:]*\\.(h|cc)$",
         "--config-file=.clang-tidy", str(together)],
        capture_output=True, text=True, check=False)
    return run.returncode == 0, run.stdout if run.returncode else ""


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    batches = []
    for folder in folders_of(build, sys.argv[2:]):
        count = -(-len(folder) // LARGEST_BATCH)
        batches += [folder[k::count] for k in range(count)]
    clean = True
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(check, build, batch, str(k)) for k, batch in enumerate(batches)]
        for job in concurrent.futures.as_completed(jobs):
            fine, text = job.result()
            clean = clean and fine
            print(text, end="", flush=True)
    print("clean" if clean else "not clean")
    sys.exit(0 if clean else 1)


if __name__ == "__main__":
    main()
