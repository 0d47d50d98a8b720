"""What a long run needs: a drive without end, and memory, open files and threads of the process that runs it."""
import itertools
import os


def state_of(pid):
    """Resident memory (MiB), open files, threads; None once the process is gone."""
    try:
        with open(f"/proc/{pid}/status", encoding="ascii", errors="replace") as lines:
            fields = dict(line.split(":", 1) for line in lines if ":" in line)
        files = len(os.listdir(f"/proc/{pid}/fd"))
        return int(fields["VmRSS"].split()[0]) / 1024, files, int(fields["Threads"])
    except (FileNotFoundError, ProcessLookupError, KeyError):
        return None


def table(rows):
    """Lines of a table of what `rows` say: sweeps so far, milliseconds a sweep since the row before, and the state."""
    yield f"{'sweeps':>8} {'ms':>7} {'RSS MiB':>8} {'files':>6} {'threads':>8}"
    for sweeps, ms, (rss_mb, files, threads) in rows:
        yield f"{sweeps:8d} {ms:7.1f} {rss_mb:8.1f} {files:6d} {threads:8d}"


def print_growth(rows):
    """Says how the last tenth of the rows differs from the tenth after the first, which is starting up, on average.
    Returns the growth of memory (MiB), open files and threads."""
    part = max(1, len(rows) // 10)
    skip = max(1, round(0.1 * len(rows)))

    def growth(key):
        early, late = rows[skip:skip + part], rows[-part:]
        return sum(map(key, late)) / len(late) - sum(map(key, early)) / len(early)

    memory, files, threads = (growth(lambda row, i=i: row[2][i]) for i in range(3))
    print(f"last tenth against the second: {growth(lambda row: row[1]):+.1f} ms, {memory:+.1f} MiB, {files:+.1f} files, "
          f"{threads:+.1f} threads")
    return memory, files, threads


def there_and_back(items):
    """The items forwards and backwards without end; neither end comes twice in a row."""
    return itertools.cycle(items + items[-2:0:-1])
