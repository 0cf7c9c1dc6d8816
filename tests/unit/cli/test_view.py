"""`crumple view DIR`: the page is written, opened if asked for, and a folder without results is refused."""

import webbrowser

from tests.support.result.synthetic_tube import tube_result

from crumple.result import write


def test_the_page_is_written_and_opened(run_command, tmp_path, monkeypatch):
    opened = []
    monkeypatch.setattr(webbrowser, "open", lambda url: opened.append(url) or True)
    write(tube_result(), tmp_path)
    code, out, err = run_command("view", tmp_path)
    assert (code, err) == (0, "")
    assert str(tmp_path / "view.html") in out
    assert opened == [(tmp_path / "view.html").resolve().as_uri()]
    code, out, _ = run_command("view", tmp_path, "--no-browser", "--page", tmp_path / "other.html")
    assert code == 0
    assert (tmp_path / "other.html").stat().st_size > 500_000
    assert len(opened) == 1


def test_a_result_without_shapes_is_refused(run_command, tmp_path):
    write(tube_result(states=None), tmp_path)
    code, _, err = run_command("view", tmp_path, "--no-browser")
    assert code == 2
    assert "there are too few shapes to show" in err


def test_a_folder_without_results_is_refused(run_command, tmp_path):
    code, _, err = run_command("view", tmp_path, "--no-browser")
    assert code == 2
    assert "there is no result here" in err
    assert list(tmp_path.iterdir()) == []
