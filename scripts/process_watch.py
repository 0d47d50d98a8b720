"""Memory, open files and threads of a running process, from /proc."""
import os


def state_of(pid):
    """Resident memory (MB), open files, threads; None once the process is gone."""
    try:
        with open(f"/proc/{pid}/status", encoding="ascii", errors="replace") as lines:
            fields = dict(line.split(":", 1) for line in lines if ":" in line)
        files = len(os.listdir(f"/proc/{pid}/fd"))
        return int(fields["VmRSS"].split()[0]) / 1024, files, int(fields["Threads"])
    except (FileNotFoundError, ProcessLookupError, KeyError):
        return None


def table(rows):
    """Lines of a table of what `rows` say: sweeps so far, milliseconds a sweep since the row before, and the state."""
    yield f"{'sweeps':>8} {'ms':>7} {'RSS MB':>8} {'files':>6} {'threads':>8}"
    for sweeps, ms, (rss_mb, files, threads) in rows:
        yield f"{sweeps:8d} {ms:7.1f} {rss_mb:8.1f} {files:6d} {threads:8d}"


def growth(rows, key, head=0.1):
    """Mean of the last tenth of the rows minus mean of the tenth after the first (`head`: what starting up takes)."""
    skip = max(1, round(head * len(rows)))
    part = max(1, len(rows) // 10)
    early, late = rows[skip:skip + part], rows[-part:]
    return sum(map(key, late)) / len(late) - sum(map(key, early)) / len(early)
