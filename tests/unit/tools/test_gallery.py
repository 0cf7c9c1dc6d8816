"""The gallery's script runs, shows every section type, and its pages stay small."""

import re

from tools.gallery import EXHIBITS, LARGEST_SVG, write_gallery


def test_gallery(tmp_path):
    *pictures, page = write_gallery(tmp_path)
    text = page.read_text(encoding="utf-8")
    assert len(pictures) == len(EXHIBITS)
    for exhibit, picture in zip(EXHIBITS, pictures, strict=True):
        svg = picture.read_text(encoding="utf-8")
        assert svg.startswith("<svg")
        assert len(svg.encode()) <= LARGEST_SVG
        assert f"(gallery/{exhibit.key}.svg)" in text
    assert "typical, not design values" in text
    # every law has a trust level, every capacity is a number
    assert len(re.findall(r"\((derived|quoted|measured|assumed|published)\)", text)) >= 2 * len(EXHIBITS)
    assert "nan" not in text.lower().split()
