"""Files of the opened folder: nothing outside is reached, nothing is lost."""

import pytest

pytest.importorskip("starlette")

from crumple.app.folder import LARGEST, Folder
from crumple.errors import InputError


@pytest.fixture(name="folder")
def _folder(tmp_path):
    inside = tmp_path / "inside"
    (inside / "below").mkdir(parents=True)
    (tmp_path / "secret.yaml").write_text("secret")
    (inside / "a.yaml").write_text("a: 1  # kept\n")
    (inside / "below" / "b.yml").write_text("b: 1\n")
    (inside / "link.yaml").symlink_to(tmp_path / "secret.yaml")
    (inside / "out").symlink_to(tmp_path)
    (inside / ".hidden.yaml").write_text("hidden")
    (inside / "notes.txt").write_text("notes")
    return Folder(inside)


def test_input_files_are_listed(folder):
    assert folder.files() == ["a.yaml"]


@pytest.mark.parametrize(
    "name",
    [
        "../secret.yaml", "link.yaml", "out/secret.yaml", "/etc/x.yaml", "below/../../secret.yaml", "",
        "a.yaml\0", "notes.txt", ".hidden.yaml", "x" * 300 + ".yaml", "none/x.yaml", None, 3, ["a.yaml"],
        ".yaml", "a.yaml/x.yaml", "a\nb.yaml",
    ],
)  # fmt: skip
def test_no_name_leads_out(folder, name):
    for act in (folder.open, lambda one: folder.save(one, "x", ""), lambda one: folder.keep_draft(one, "x")):
        with pytest.raises(InputError):
            act(name)
    assert (folder.path.parent / "secret.yaml").read_text() == "secret"


def test_a_file_below_is_opened(folder):
    assert folder.open("below/b.yml").text == "b: 1\n"


def test_saving_refuses_a_file_that_changed(folder):
    opened = folder.open("a.yaml")
    seen = folder.save("a.yaml", "a: 2\n", opened.seen)
    assert (folder.path / "a.yaml").read_bytes() == b"a: 2\n"
    (folder.path / "a.yaml").write_text("a: 3\n")
    with pytest.raises(InputError, match="changed by another program"):
        folder.save("a.yaml", "a: 4\n", seen)
    assert (folder.path / "a.yaml").read_text() == "a: 3\n"
    with pytest.raises(InputError, match="there is such a file already"):
        folder.save("a.yaml", "new", "")
    (folder.path / "a.yaml").unlink()
    with pytest.raises(InputError, match="changed by another program"):
        folder.save("a.yaml", "a: 4\n", seen)


def test_line_ends_mark_and_permissions_stay(folder):
    place = folder.path / "dos.yaml"
    place.write_bytes(b"\xef\xbb\xbfa: 1\r\nb: 2\r\n")
    place.chmod(0o640)
    opened = folder.open("dos.yaml")
    assert opened.text == "a: 1\nb: 2\n"
    folder.save("dos.yaml", "a: 1\nb: 3\n", opened.seen)
    assert place.read_bytes() == b"\xef\xbb\xbfa: 1\r\nb: 3\r\n"
    assert place.stat().st_mode & 0o777 == 0o640


def test_drafts_wait_beside_their_file(folder):
    folder.keep_draft("a.yaml", "draft: ä\n")
    opened = folder.open("a.yaml")
    assert (opened.text, opened.draft) == ("a: 1  # kept\n", "draft: ä\n")
    folder.save("a.yaml", "a: 5\n", opened.seen)
    assert folder.open("a.yaml").draft is None
    folder.keep_draft("a.yaml", "again")
    folder.discard("a.yaml")
    assert folder.open("a.yaml").draft is None
    assert (
        sorted(one.name for one in folder.path.iterdir() if "draft" in one.name or "part" in one.name) == []
    )


def test_a_draft_that_is_a_link_is_not_shown(folder):
    (folder.path / ".a.yaml.draft").symlink_to(folder.path.parent / "secret.yaml")
    assert folder.open("a.yaml").draft is None
    folder.keep_draft("a.yaml", "mine")
    assert (folder.path.parent / "secret.yaml").read_text() == "secret"


def test_large_and_binary_files_are_refused(folder):
    (folder.path / "large.yaml").write_bytes(b"#" * (LARGEST + 1))
    (folder.path / "binary.yaml").write_bytes(b"\xff\xfe\x00")
    (folder.path / "folder.yaml").mkdir()
    for name in ("large.yaml", "binary.yaml", "folder.yaml", "missing.yaml"):
        with pytest.raises(InputError):
            folder.open(name)
