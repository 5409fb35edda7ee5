"""An FMU that a test builds: an orthosis whose strut creeps, FMI 2.0 for co-simulation, in C.

torque = k φ + c (φ - x), τ dx/dt = φ - x, φ = angle - neutral, the angle held over a step: exact then.
"""

from __future__ import annotations

import platform
import subprocess
from pathlib import Path
from zipfile import ZipFile

SOURCE = r"""
#include <math.h>
#include <stdlib.h>
typedef unsigned int Ref;
typedef struct { double value[6]; } Model; /* angle, torque, k, neutral, c, tau */
typedef struct { Model m; double x; int begun; } Own;
#define OK 0
#define ERROR 3
static double turned(Own *o) { return o->m.value[0] - o->m.value[3]; }
void *fmi2Instantiate(const char *a, int b, const char *c, const char *d, const void *e, int f, int g) {
    Own *o = calloc(1, sizeof(Own));
    double start[6] = {0.0, 0.0, 60.0, 0.0, 20.0, 0.5};
    for (int i = 0; i < 6; i++) o->m.value[i] = start[i];
    return o;
}
void fmi2FreeInstance(void *p) { free(p); }
int fmi2SetReal(void *p, const Ref *r, size_t n, const double *v) {
    for (size_t i = 0; i < n; i++) ((Own *)p)->m.value[r[i]] = v[i];
    return OK;
}
int fmi2GetReal(void *p, const Ref *r, size_t n, double *v) {
    Own *o = p;
    o->m.value[1] = o->m.value[2] * turned(o) + o->m.value[4] * (turned(o) - o->x);
    for (size_t i = 0; i < n; i++) v[i] = o->m.value[r[i]];
    return OK;
}
int fmi2ExitInitializationMode(void *p) { ((Own *)p)->x = turned(p); return OK; }
int fmi2DoStep(void *p, double t, double h, int b) {
    Own *o = p;
    o->x = turned(o) + (o->x - turned(o)) * exp(-h / o->m.value[5]);
    return OK;
}
const char *fmi2GetTypesPlatform(void) { return "default"; }
const char *fmi2GetVersion(void) { return "2.0"; }
int fmi2SetupExperiment(void *p, int a, double b, double c, int d, double e) { return OK; }
int fmi2EnterInitializationMode(void *p) { return OK; }
int fmi2Terminate(void *p) { return OK; }
int fmi2Reset(void *p) { return OK; }
#define REFUSED(name) int name(void *p) { return ERROR; }
REFUSED(fmi2SetDebugLogging) REFUSED(fmi2GetInteger) REFUSED(fmi2GetBoolean) REFUSED(fmi2GetString)
REFUSED(fmi2SetInteger) REFUSED(fmi2SetBoolean) REFUSED(fmi2SetString) REFUSED(fmi2GetFMUstate)
REFUSED(fmi2SetFMUstate) REFUSED(fmi2FreeFMUstate) REFUSED(fmi2SerializedFMUstateSize)
REFUSED(fmi2SerializeFMUstate) REFUSED(fmi2DeSerializeFMUstate) REFUSED(fmi2GetDirectionalDerivative)
REFUSED(fmi2SetRealInputDerivatives) REFUSED(fmi2GetRealOutputDerivatives) REFUSED(fmi2CancelStep)
REFUSED(fmi2GetStatus) REFUSED(fmi2GetRealStatus) REFUSED(fmi2GetIntegerStatus)
REFUSED(fmi2GetBooleanStatus) REFUSED(fmi2GetStringStatus)
"""

DESCRIPTION = """<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="strut" guid="{{strut}}">
  <CoSimulation modelIdentifier="strut" canHandleVariableCommunicationStepSize="true"/>
  <UnitDefinitions>
    <Unit name="rad"/><Unit name="N.m"/><Unit name="N.m/rad"/><Unit name="s"/>
  </UnitDefinitions>
  <ModelVariables>
    <ScalarVariable name="angle" valueReference="0" causality="input"><Real start="0" unit="{angle}"/></ScalarVariable>
    <ScalarVariable name="torque" valueReference="1" causality="output"><Real unit="N.m"/></ScalarVariable>
    <ScalarVariable name="k" valueReference="2" causality="parameter" variability="fixed">
      <Real start="60" min="10" max="400" unit="N.m/rad"/></ScalarVariable>
    <ScalarVariable name="neutral" valueReference="3" causality="parameter" variability="fixed">
      <Real start="0" min="-0.3" max="0.3" unit="rad"/></ScalarVariable>
    <ScalarVariable name="c" valueReference="4" causality="parameter" variability="fixed">
      <Real start="20" unit="N.m/rad"/></ScalarVariable>
    <ScalarVariable name="tau" valueReference="5" causality="parameter" variability="fixed">
      <Real start="0.5" unit="s"/></ScalarVariable>
  </ModelVariables>
  <ModelStructure><Outputs><Unknown index="2"/></Outputs></ModelStructure>
</fmiModelDescription>
"""
FOLDERS = {"Linux": ("linux64", ".so"), "Darwin": ("darwin64", ".dylib"), "Windows": ("win64", ".dll")}


def described(file: Path, angle: str = "rad") -> Path:
    """The FMU without its library: enough to be read, not to be run."""
    with ZipFile(file, "w") as archive:
        archive.writestr("modelDescription.xml", DESCRIPTION.format(angle=angle))
    return file


def built(file: Path, compiler: str) -> Path:
    """The whole FMU, its library compiled for this machine."""
    folder, ending = FOLDERS[platform.system()]
    source, library = file.with_suffix(".c"), file.with_name(f"strut{ending}")
    source.write_text(SOURCE, encoding="utf-8")
    subprocess.run([compiler, "-shared", "-fPIC", "-O1", str(source), "-o", str(library), "-lm"], check=True)
    described(file)
    with ZipFile(file, "a") as archive:
        archive.write(library, f"binaries/{folder}/strut{ending}")
    source.unlink()
    library.unlink()
    return file
