"""scripts/check-layers on small trees: a good one, and one for each kind of fault."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).parents[2] / "scripts" / "check-layers"


class Layers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "scripts").mkdir()
        shutil.copy(SCRIPT, self.root / "scripts")
        self.write("sim/io/csv.h", "namespace continuum { struct CsvTable {}; }")
        self.write("sim/io/csv.cc", '#include "sim/io/csv.h"')
        self.write("sim/model/model_spec.h", '#include "sim/io/csv.h"\nnamespace continuum { class ModelSpec {}; }')

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text + "\n")

    def faults(self):
        git = ["git", "-C", self.root, "-c", "init.defaultBranch=main"]
        subprocess.run([*git, "init", "--quiet"], check=True)
        subprocess.run([*git, "add", "."], check=True)
        done = subprocess.run([sys.executable, self.root / "scripts" / "check-layers"], text=True,
                              stdout=subprocess.PIPE)
        self.assertEqual(done.returncode != 0, done.stdout != "")
        return done.stdout

    def test_a_good_tree_has_none(self):
        self.assertEqual(self.faults(), "")

    def test_an_include_of_a_higher_folder_is_one(self):
        self.write("sim/io/csv.cc", '#include "sim/model/model_spec.h"')
        self.assertIn("sim/io/csv.cc: may not include sim/model/model_spec.h", self.faults())

    def test_an_include_that_is_commented_out_is_none(self):
        self.write("sim/io/csv.cc", '// #include "sim/model/model_spec.h"')
        self.assertEqual(self.faults(), "")

    def test_files_that_include_each_other_are_one(self):
        self.write("sim/io/a.h", '#include "sim/io/b.h"')
        self.write("sim/io/b.h", '#include "sim/io/c.h"')
        self.write("sim/io/c.cc", '#include "sim/io/a.h"')  # a source stands for its header
        self.write("sim/io/c.h", "")
        self.assertIn("include each other: sim/io/a, sim/io/b, sim/io/c", self.faults())

    def test_two_public_types_of_one_name_are_one(self):
        self.write("identification/fit/table.h", "namespace continuum { struct CsvTable { int rows; }; }")
        self.assertIn("two types continuum::CsvTable: identification/fit/table.h, sim/io/csv.h", self.faults())

    def test_types_of_one_name_in_two_namespaces_are_none(self):
        self.write("models/spa/table.h", "namespace continuum::spa { struct CsvTable {}; }")
        self.assertEqual(self.faults(), "")

    def test_a_type_of_a_source_in_a_namespace_with_a_name_is_one_too(self):
        self.write("sim/io/mat.cc", "namespace continuum { struct [[nodiscard]] CsvTable final : Base<int> { char c = '{'; }; }")
        self.assertIn("two types continuum::CsvTable: sim/io/csv.h, sim/io/mat.cc", self.faults())

    def test_a_type_that_no_other_source_sees_is_none(self):
        self.write("sim/io/mat.cc", "namespace continuum {\nnamespace {\nstruct CsvTable {};\n}\n}")
        self.assertEqual(self.faults(), "")

    def test_braces_and_slashes_in_literals_and_comments_do_not_count(self):
        self.write("sim/io/mat.h", 'namespace continuum {\ninline auto f() { return "http://x{"; }  /* { */\nstruct CsvTable {};\n}')
        self.assertIn("two types continuum::CsvTable", self.faults())

    def test_an_include_is_found_however_it_is_spelt(self):
        self.write("sim/io/csv.cc", '  #  include <sim/model/model_spec.h>')
        self.assertIn("sim/io/csv.cc: may not include sim/model/model_spec.h", self.faults())

    def test_the_name_of_an_effect_outside_its_card_is_one(self):
        self.write("plugin/effects/dahl.h", 'struct Dahl { static constexpr std::string_view kName = "dahl"; };')
        self.write("sim/io/csv.cc", 'const char* name = "continuum.dahl";')
        self.assertIn("dahl", self.faults())

    def test_a_folder_that_is_in_no_table_is_one(self):
        self.write("sim/attic/old.h", "")
        self.assertIn("sim/attic/old.h: the folder is not in the table", self.faults())


unittest.main()
