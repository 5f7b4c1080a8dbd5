//! `rig.toml`: a rig file with the keys that differ from a preset, and no others.

/// The rig file's text.
pub(super) fn toml() -> String {
    "# A head like that of the 2006 report, with a heavier laser, a faster relay and a little backlash.\n\
     # `tracelight rigs show report` prints every key with its unit; keys that are left out here are as in `base`.\n\
     base = \"report\"\n\
     name = \"mine\"\n\
     description = \"a heavier laser, a faster relay, a little backlash\"\n\
     \n\
     [model.relay]\n\
     on = \"2ms\"\n\
     off = \"1ms\"\n\
     \n\
     [model.tilt.body]\n\
     mass = \"0.25kg\"\n\
     \n\
     # what the simulated head is, and the controller does not know\n\
     [truth.wear]\n\
     backlash = \"0.0002rad\"\n"
        .to_owned()
}
