"""Heights of pages in a browser before anything is unfolded.

``python tests/page_heights.py FOLDER``: the folder holds GROUP/NAME/report.html of any number of
cases. The median is printed last.
"""

import argparse
import shutil
import statistics
from pathlib import Path

BROWSER = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
SCREEN = (1300, 900)


def heights(pages: list[Path], width: int, height: int) -> dict[Path, int]:
    """Pixels of each page from its top to its end.

    Parameters
    ----------
    pages : list of Path
        Files of pages.
    width, height : int
        Those of the window.
    """
    from playwright.sync_api import sync_playwright

    found = {}
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=list(BROWSER)
        )
        tab = browser.new_page(viewport={"width": width, "height": height})
        for page in pages:
            tab.goto(page.resolve().as_uri())
            found[page] = tab.evaluate("document.documentElement.scrollHeight")
        browser.close()
    return found


def main() -> None:
    """Print the height of each page below a folder, and the median."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--width", type=int, default=SCREEN[0])
    parser.add_argument("--every", type=int, default=1, help="measure each n-th page alone")
    asked = parser.parse_args()
    pages = sorted(asked.folder.glob("*/*/report.html"))[:: asked.every]
    found = heights(pages, asked.width, SCREEN[1])
    for page, pixels in found.items():
        print(f"{pixels:6d} {page.parent.relative_to(asked.folder)}")
    print(f"median of {len(found)} pages at {asked.width} px: {statistics.median(found.values())}")


if __name__ == "__main__":
    main()
