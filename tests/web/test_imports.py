"""Imports of the pages run one way: pages -> panels -> {plots, components, core}, and never to a twin."""

MAY_IMPORT = {
    "": {"pages"},
    "pages": {"panels", "plots", "components", "core"},
    "panels": {"plots", "components", "core"},
    "components": {"components", "core"},
    "plots": {"plots", "core"},
    "core": {"core"},
}


def test_there_are_scripts_in_every_room(scripts):
    assert {script.room for script in scripts} >= {"core", "plots", "components", "panels", "pages"}


def test_every_import_is_a_file_of_ours(scripts):
    known = {script.path for script in scripts}
    missing = [f"{s.path} imports {target}" for s in scripts for target in s.imports if target not in known]
    assert missing == []


def test_imports_follow_the_arrows(scripts):
    against = [
        f"{script.path} imports {target}"
        for script in scripts
        for target in script.imports
        if (target.parts[0] if len(target.parts) > 1 else "") not in MAY_IMPORT.get(script.room, set())
    ]
    assert against == []
