"""What made a result: the commit that is checked out, whichever way git keeps it."""

import subprocess
from pathlib import Path

from fe_drivetrain.common.provenance import commit_of


def test_the_commit_is_that_of_the_clone_or_worktree(tmp_path: Path) -> None:
    def git(*words: str) -> str:
        made = ["-c", "user.name=a", "-c", "user.email=a@example.org"]
        done = subprocess.run(
            ["git", *made, *words], cwd=tmp_path, check=True, capture_output=True, text=True
        )
        return done.stdout.strip()

    assert commit_of(tmp_path) == ""
    git("init", "--quiet")
    assert commit_of(tmp_path) == ""  # none yet
    git("commit", "--quiet", "--allow-empty", "--message", "one")
    one = git("rev-parse", "HEAD")
    assert commit_of(tmp_path) == one
    git("worktree", "add", "--quiet", "-b", "other", "beside")
    git("-C", "beside", "commit", "--quiet", "--allow-empty", "--message", "two")
    two = git("-C", "beside", "rev-parse", "HEAD")
    assert (commit_of(tmp_path), commit_of(tmp_path / "beside")) == (one, two)
    git("pack-refs", "--all")
    assert (commit_of(tmp_path), commit_of(tmp_path / "beside")) == (one, two)
    git("checkout", "--quiet", "--detach", two)
    assert commit_of(tmp_path) == two
    (tmp_path / ".git" / "HEAD").write_text("no commit")
    assert commit_of(tmp_path) == ""
