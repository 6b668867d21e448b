#include "bench.h"

namespace continuum {
namespace {

// What `continuum replay` says to a damaged file. Where `old` is empty the whole file is replaced.
struct Bad {
  const char *name, *file, *old;
  std::string by;
  std::vector<std::string> words;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

class BadFile : public testing::AppBench, public ::testing::WithParamInterface<Bad> {};

TEST_P(BadFile, IsRefusedByFileAndPlace) {
  const Bad& bad = GetParam();
  if (*bad.old == '\0') {
    files_.Write(bad.file, bad.by);
  } else {
    Spoil(bad.file, bad.old, bad.by);
  }
  auto words = bad.words;
  words.push_back(bad.file);
  ExpectRefused({"replay", "experiment.yaml", "--out", "out/of/it"}, words);
}

class BadFileOnceMore : public testing::AppBench {};

TEST_F(BadFileOnceMore, IsRefusedByCheck) {
  Spoil("experiment.yaml", "joint:hinge", "joint:elbow");
  ExpectRefused({"check", "experiment.yaml"}, {"yaml:6: parameters[0]", "elbow"});
  Spoil("experiment.yaml", "unit: rad", "unit: kg");
  ExpectRefused({"check", "experiment.yaml"}, {"yaml:5: outputs[0].unit", "'rad'", "'kg'"});
}

TEST_F(BadFileOnceMore, IsRefusedByCheckWhereACandidateHasNoPlace) {
  Spoil("experiment.yaml", "format: 1",
        "format: 1\ncandidates: [{effect: payload, where: \"joint:hinge\"}]");
  ExpectRefused({"check", "experiment.yaml"}, {"candidates: payload", "joint:hinge"});
}

const std::string kJunk("\x7f\x45LF\0\1\2\3\xff\xfe\n\0;\t\x80", 16);

INSTANTIATE_TEST_SUITE_P(
    Log, BadFile,
    ::testing::Values(
        Bad{"Empty", "log.csv", "", "", {"header"}},
        Bad{"HeaderOnly", "log.csv", "", "t,u,q\n", {"two rows"}},
        Bad{"OneRow", "log.csv", "", "t,u,q\n0,0,0\n", {"two rows"}},
        Bad{"Junk", "log.csv", "", kJunk, {"text file"}},
        Bad{"Utf16", "log.csv", "", std::string("\xff\xfet\0,\0u\0", 8), {"UTF-16", "iconv"}},
        Bad{"NanTime", "log.csv", "0.1,0.1,0.01", "nan,0.1,0.01", {"log.csv:3", "'t'", "'nan'"}},
        Bad{"NanInput", "log.csv", "0.1,0.1,0.01", "0.1,NaN,0.01", {"log.csv:3", "'u'", "'NaN'"}},
        Bad{"EmptyInput", "log.csv", "0.1,0.1,0.01", "0.1,,0.01", {"log.csv:3", "'u'", "empty"}},
        Bad{"InfiniteOutput", "log.csv", "0.1,0.1,0.01", "0.1,0.1,inf", {"log.csv:3", "'q'"}},
        Bad{"Word", "log.csv", "0.1,0.1,0.01", "0.1,up,0.01", {"log.csv:3", "'u'", "'up'"}},
        Bad{"TwoSigns", "log.csv", "0.1,0.1,0.01", "0.1,+-1,0.01", {"log.csv:3", "'+-1'"}},
        Bad{"HugeNumber", "log.csv", "0.1,0.1,0.01", "0.1,1e999,0.01", {"log.csv:3", "1e999"}},
        Bad{"LongWord",
            "log.csv",
            "0.1,0.1,0.01",
            "0.1," + std::string(9999, 'x') + ",0",
            {"xxx...'"}},
        Bad{"LongHeader", "log.csv", "t,u,q", std::string(9999, 'x') + ",u,q", {"'t'", "xxx..."}},
        Bad{"HugeTime", "log.csv", "0.3,", "1e50,", {"1e9 time steps", "1e+50"}},
        Bad{"HugeOutput",
            "log.csv",
            "0.1,0.1,0.01",
            "0.1,0.1,1e300",
            {"log.csv:3", "'q'", "1e100"}},
        Bad{"HugeInput", "log.csv", "0.1,0.1,0.01", "0.1,1e300,0", {"log.csv:3", "'u'", "1e100"}},
        Bad{"TimeGoesBack", "log.csv", "0.2,0.1", "0.05,0.1", {"log.csv:4", "0.05 after 0.1"}},
        Bad{"TimeStands", "log.csv", "0.2,0.1", "0.1,0.1", {"log.csv:4", "0.1 after 0.1"}},
        Bad{"ColumnTwice", "log.csv", "t,u,q", "t,u,q,q", {"log.csv:1", "'q' twice"}},
        Bad{"ColumnMissing", "log.csv", "t,u,q", "t,u,p", {"log.csv:1", "'q'"}},
        Bad{"NoHeader", "log.csv", "t,u,q\n", "", {"log.csv:1"}},
        Bad{"ShortRow", "log.csv", "0.1,0.1,0.01", "0.1,0.1", {"log.csv:3", "3 cells", "2"}},
        Bad{"LongRow", "log.csv", "0.1,0.1,0.01", "0.1,0.1,0,0", {"log.csv:3", "3 cells", "4"}},
        Bad{"OpenQuote", "log.csv", "0.1,0.1,0.01", "0.1,\"0.1,0.01", {"log.csv:3", "quote"}},
        Bad{"DecimalComma", "log.csv", "0.1,0.1,0.01", "0,1;0,1;0,01", {"log.csv:3"}},
        Bad{"NoMeasurement", "log.csv", "", "t,u,q\n0,0,\n1,0,nan\n", {"'q'", "at least one"}}),
    testing::kCaseName);

INSTANTIATE_TEST_SUITE_P(
    Experiment, BadFile,
    ::testing::Values(
        Bad{"Empty", "experiment.yaml", "", "", {"a map"}},
        Bad{"Junk", "experiment.yaml", "", kJunk, {}},
        Bad{"LongText",
            "experiment.yaml",
            "format: 1",
            "format: |\n " + std::string(9999, 'x') + "\n y",
            {"yaml:1: format", "'xxx", "xxx...'"}},
        Bad{"List", "experiment.yaml", "", "- 1\n- 2\n", {"a map", "a list"}},
        Bad{"Cycle", "experiment.yaml", "[{file: log.csv}]", "&a [*a]", {"yaml:7", "logs[0]"}},
        Bad{"UnknownAnchor", "experiment.yaml", "[{file: log.csv}]", "*nobody", {"yaml:7"}},
        Bad{"Deep", "experiment.yaml", "", std::string(100000, '['), {}},
        Bad{"Unclosed", "experiment.yaml", "[{file: log.csv}]", "[{file: log.csv}", {"yaml:"}},
        Bad{"UnknownKey", "experiment.yaml", "model:", "modle:", {"yaml:2", "modle"}},
        Bad{"KeyTwice", "experiment.yaml", "format: 1", "format: 1\nformat: 1", {"'format' twice"}},
        Bad{"WrongType", "experiment.yaml", "column: u", "column: {u: 1}", {"yaml:4", "column"}},
        Bad{"TwoSigns", "experiment.yaml", "lower: 0.01", "lower: +-1", {"yaml:6", "'+-1'"}},
        Bad{"NoNumber", "experiment.yaml", "upper: 1", "upper: .inf", {"yaml:6", "upper"}},
        Bad{"BoundsReversed", "experiment.yaml", "upper: 1", "upper: 0.001", {"yaml:6", "upper"}},
        Bad{"NoSuchLog", "experiment.yaml", "log.csv", "none.csv", {"yaml:7", "none.csv"}},
        Bad{"LogIsAFolder", "experiment.yaml", "log.csv", ".", {"yaml:7", "folder"}},
        Bad{"UnknownActuator",
            "experiment.yaml",
            "actuator: motor",
            "actuator: engine",
            {"yaml:4: inputs[0]", "'engine'", "motor"}},
        Bad{"UnknownSensor",
            "experiment.yaml",
            "sensor: angle",
            "sensor: angel",
            {"yaml:5: outputs[0]", "'angel'", "angle, tip_pos"}},
        Bad{"NoComponent",
            "experiment.yaml",
            "sensor: angle",
            "sensor: tip_pos",
            {"yaml:5: outputs[0]", "tip_pos[0]"}},
        Bad{"ComponentTooHigh",
            "experiment.yaml",
            "sensor: angle",
            "sensor: \"tip_pos[12]\"",
            {"yaml:5: outputs[0]", "below 3", "12"}},
        Bad{"TurnOfAScalar",
            "experiment.yaml",
            "sensor: angle",
            "sensor: angle, angle: 0.1",
            {"yaml:5: outputs[0].angle", "a vector or a quaternion"}},
        Bad{"TurnOfAForce",
            "experiment.yaml",
            "sensor: angle",
            "actuator: motor, angle: 0.1",
            {"yaml:5: outputs[0].angle", "force"}},
        Bad{"QuaternionOfAForce",
            "experiment.yaml",
            "column: q, unit: rad, sensor: angle",
            "columns: [t, u, q, w], actuator: motor",
            {"yaml:5", "one column"}},
        Bad{"NotAQuaternion", "experiment.yaml", "column: q", "columns: [t, u, q, q]", {"yaml:5"}},
        Bad{"UnknownUnit", "experiment.yaml", "unit: Nm", "unit: furlong", {"yaml:4", "furlong"}},
        Bad{"UnknownTargetOfALog",
            "experiment.yaml",
            "{file: log.csv}",
            "{file: log.csv, set: {\"body:elbow\": {mass: 1}}}",
            {"'log'", "elbow"}},
        Bad{"UnknownAttributeOfALog",
            "experiment.yaml",
            "{file: log.csv}",
            "{file: log.csv, set: {\"joint:hinge\": {colour: 1}}}",
            {"'log'", "colour"}},
        Bad{"NegativeMassOfALog",
            "experiment.yaml",
            "{file: log.csv}",
            "{file: log.csv, set: {\"body:link\": {mass: -1}}}",
            {"'log'", "body:link: mass", ">= 0 kg", "-1"}},
        Bad{"NegativeInertiaOfALog",
            "experiment.yaml",
            "{file: log.csv}",
            "{file: log.csv, set: {\"body:link\": {\"inertia[1]\": -0.1}}}",
            {"'log'", "inertia[1]", ">= 0 kg*m^2", "-0.1"}},
        Bad{"NegativeDampingOfALog",
            "experiment.yaml",
            "{file: log.csv}",
            "{file: log.csv, set: {\"joint:hinge\": {damping: -2}}}",
            {"'log'", "joint:hinge: damping", ">= 0", "-2"}},
        Bad{"NoTimeStepOfALog",
            "experiment.yaml",
            "{file: log.csv}",
            "{file: log.csv, set: {option: {timestep: 0}}}",
            {"'log'", "option: timestep", "> 0 s", "0"}},
        Bad{"TimeInMetres", "experiment.yaml", "unit: s", "unit: m", {"yaml:3", "'s'", "'m'"}},
        Bad{"AngleInKilograms",
            "experiment.yaml",
            "unit: rad",
            "unit: kg",
            {"yaml:5: outputs[0].unit", "'rad'", "'kg'"}},
        Bad{"PositionInRadians",
            "experiment.yaml",
            "unit: rad, sensor: angle",
            "unit: rad, sensor: 'tip_pos[0]'",
            {"yaml:5: outputs[0].unit", "'m'", "'rad'"}},
        Bad{"UnknownTargetOfAParameter",
            "experiment.yaml",
            "joint:hinge",
            "joint:elbow",
            {"yaml:6: parameters[0]", "elbow"}},
        Bad{"StartOutsideItsBounds",
            "experiment.yaml",
            "lower: 0.01",
            "lower: 0.5",
            {"yaml:6: parameters[0]", "0.5", "0.1", "what the model has"}},
        Bad{"FutureFormat", "experiment.yaml", "format: 1", "format: 2", {"yaml:1", "format 1"}}),
    testing::kCaseName);

INSTANTIATE_TEST_SUITE_P(
    Model, BadFile,
    ::testing::Values(
        Bad{"Empty", "model.xml", "", "", {}}, Bad{"Junk", "model.xml", "", kJunk, {}},
        Bad{"NoXml", "model.xml", "", "a model", {}},
        Bad{"Unclosed", "model.xml", "</mujoco>", "", {}},
        Bad{"UnknownElement", "model.xml", "<sensor>", "<feeler/><sensor>", {"feeler"}},
        Bad{"UnknownAttribute", "model.xml", "damping=", "dampening=", {"dampening"}},
        Bad{"WordAsNumber", "model.xml", "damping=\"0.1\"", "damping=\"much\"", {"damping"}},
        Bad{"NoMass", "model.xml", "mass=\"1\"", "mass=\"0\"", {"mass"}},
        Bad{"NoTimestep", "model.xml", "timestep=\"0.01\"", "timestep=\"0\"", {"timestep"}},
        Bad{"NegativeTimestep", "model.xml", "timestep=\"0.01\"", "timestep=\"-1\"", {"timestep"}},
        Bad{"NanTimestep", "model.xml", "timestep=\"0.01\"", "timestep=\"nan\"", {"timestep"}},
        Bad{"NoSuchMesh",
            "model.xml",
            "<worldbody>",
            "<asset><mesh name='m' file='none.obj'/></asset><worldbody>",
            {"none.obj"}},
        Bad{"NoSuchInclude",
            "model.xml",
            "<worldbody>",
            "<include file='none.xml'/><worldbody>",
            {"none.xml"}},
        Bad{"IncludesItself",
            "model.xml",
            "<worldbody>",
            "<include file='model.xml'/><worldbody>",
            {"already included"}},
        Bad{"UnknownPlugin",
            "model.xml",
            "<worldbody>",
            "<extension><plugin plugin='continuum.ghost'/></extension><worldbody>",
            {"ghost"}},
        Bad{"PluginBindsNothing",
            "model.xml",
            "<worldbody>",
            "<extension><plugin plugin='continuum.coulomb'><instance name='dry'><config "
            "key='joint' value='elbow'/></instance></plugin></extension><worldbody>",
            {"elbow"}},
        Bad{"PluginWithoutAValue",
            "model.xml",
            "<worldbody>",
            "<extension><plugin plugin='continuum.coulomb'><instance name='dry'><config "
            "key='joint' value='hinge'/>\n<!-- <config key='joint' value=''/> --><config value = "
            "'' "
            "key='tau_c'/></instance></plugin></extension><worldbody>",
            {"model.xml:4: config 'tau_c'", "a value", "''"}},
        Bad{"PluginOutOfRange",
            "model.xml",
            "<worldbody>",
            "<extension><plugin plugin='continuum.coulomb'><instance name='dry'><config "
            "key='joint' value='hinge'/><config key='tau_c' value='-1'/></instance></plugin>"
            "</extension><worldbody>",
            {"tau_c", "-1"}}),
    testing::kCaseName);

}  // namespace
}  // namespace continuum
