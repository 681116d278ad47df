//! `documentation/index.html`: what the FMU holds, for the one who is handed it.

use std::fmt::Write as _;

use orthopanel_fmu::{GENERATOR, Resource, Variable};
use orthopanel_model::ModalModel;

use crate::acceleration_band::Band;
use crate::html::escaped;
use crate::origin::Origin;
use crate::{FmiVersion, FmuOptions, drawing};

/// The page: variables with their places, modes, how the force is held, and where the panel comes from.
pub(crate) fn write(
    resource: &Resource,
    alone: &ModalModel,
    from: Option<&Origin<'_>>,
    options: &FmuOptions,
) -> String {
    let mut page = String::from("<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\">\n");
    page += STYLE;
    page += "<title>";
    page += &escaped(&options.name);
    page += "</title></head>\n<body>\n<h1>";
    page += &escaped(&options.name);
    page += "</h1>\n<p>";
    page += &escaped(&options.description);
    page += "</p>\n";
    if let Some(from) = from {
        page += &drawing::draw(resource, &from.panel.piece, from.panel.boundary);
    }
    page += "<h2>Variables</h2>\n";
    let table = resource.variables();
    // There are four of each mode, which few come here for.
    let (of_modes, others): (Vec<_>, Vec<_>) =
        table.variables().iter().partition(|variable| variable.quantity.causality() == "local");
    page += &listed(&others);
    let _ = write!(page, "<details>\n<summary>Coordinates and velocities of the modes: {}", of_modes.len());
    page += " variables</summary>\n";
    page += &listed(&of_modes);
    page += "</details>\n<p>";
    page += PARAMETERS;
    page += "</p>\n<h2>Force over a step</h2>\n<p>";
    page += HELD;
    if options.version == FmiVersion::Fmi2 {
        page += BY_DERIVATIVES;
    }
    page += LINEAR;
    page += EXCHANGE;
    page += "</p>\n<h2>Modes</h2>\n<p>";
    page += MODES;
    page += INITIAL_STATE;
    let doubt = from.map(|from| from.doubt.as_slice()).unwrap_or_default();
    if !doubt.is_empty() {
        page += DOUBT;
    }
    page += "</p>\n<table>\n<tr><th>mode</th><th>frequency [Hz]</th><th>damping ratio</th></tr>\n";
    let modes = alone.modes();
    let rigid = modes.iter().take_while(|mode| mode.angular_frequency == 0.0).count();
    for (index, mode) in modes.iter().enumerate() {
        let (number, frequency) =
            (index + 1 + resource.frame_motions(), mode.angular_frequency / std::f64::consts::TAU);
        let kind = if index + resource.residual_modes() < modes.len() { "" } else { ", residual" };
        let own = index.checked_sub(rigid).and_then(|flexible| doubt.get(flexible)).filter(|_| kind.is_empty());
        let known = own.map_or(String::new(), |share| format!(" &plusmn; {:.2}", share * frequency));
        // Digits enough to tell the FMU's from another's, none that are an accident of binary numbers.
        let zeta = if mode.damping_ratio == 0.0 { "0".into() } else { format!("{:.4e}", mode.damping_ratio) };
        let _ = writeln!(page, "<tr><td>{number}{kind}</td><td>{frequency:.3}{known}</td><td>{zeta}</td></tr>");
    }
    page += "</table>\n";
    page += &residual(resource, alone);
    page += &mounting(resource, alone);
    page += REFERENCE;
    if let Some(from) = from {
        page += &left_out(resource, from);
        page += &from.section();
    }
    let _ = write!(page, "<p>Written by {GENERATOR}. {LICENSES}</p>\n</body>\n</html>\n");
    page
}

/// What stands for the modes left out.
fn residual(resource: &Resource, alone: &ModalModel) -> String {
    let modes = alone.modes();
    let residual = modes.get(modes.len() - resource.residual_modes()..).unwrap_or_default();
    let (Some(first), Some(last)) = (residual.first(), residual.last()) else { return NO_RESIDUAL.into() };
    let [low, high] = [first, last].map(|mode| mode.angular_frequency / std::f64::consts::TAU);
    format!(
        "<p>The last {} modes, from {low:.0} to {high:.0} Hz, are residual modes: {RESIDUAL} {:.4e}. {STIFF}</p>\n",
        residual.len(),
        first.damping_ratio
    )
}

/// How a mount is joined to a force, and the steps at which it is stable; what is inside already.
fn mounting(resource: &Resource, alone: &ModalModel) -> String {
    let mut text = format!("{MOUNTING}<table>\n<tr><th>force</th><th>m [kg]</th>");
    for step in STEPS {
        let _ = write!(text, "<th>{step:e} s</th>");
    }
    text += "</tr>\n";
    for port in 0..resource.ports().forces.len() {
        let shapes = alone.modes().iter().filter_map(|mode| mode.at_forces.get(port));
        let yielding: f64 = shapes.map(|shape| shape * shape).sum();
        let _ = write!(text, "<tr><td>force_{}</td>", resource.names().force(port));
        if yielding > 0.0 {
            let mass = yielding.recip();
            let _ = write!(text, "<td>{mass:.3e}</td>");
            for step in STEPS {
                let (stiffness, damping) = (mass / (4.0 * step * step), mass / (2.0 * step));
                let _ = write!(text, "<td>k to {stiffness:.1e}, c to {damping:.1e}</td>");
            }
            text += "</tr>\n";
        } else {
            let _ = writeln!(text, "<td colspan=\"{}\">does not move</td></tr>", STEPS.len() + 1);
        }
    }
    text += "</table>\n";
    let connections = resource.connections().cloned().unwrap_or_default();
    if !connections.mounts.is_empty() {
        text += INSIDE;
    }
    if connections.gravity || connections.pressure || connections.base_acceleration {
        text += UNIFORM;
    }
    if connections.base_acceleration {
        text += FRAME;
    }
    if connections.rotations {
        text += ROTATIONS;
    }
    text
}

/// Steps of a master \[s\].
const STEPS: [f64; 4] = [1e-6, 1e-5, 1e-4, 1e-3];

/// A table of variables.
fn listed(variables: &[&Variable]) -> String {
    let mut table = String::from("<table>\n<tr><th>name</th><th>unit</th><th>kind</th><th>what</th></tr>\n");
    for variable in variables {
        let unit = variable.unit.unwrap_or("");
        let (name, kind) = (&variable.name, kind(variable));
        let what = escaped(&variable.description);
        // Writing to a String has nothing to fail on, here and elsewhere.
        let _ = writeln!(table, "<tr><td>{name}</td><td>{unit}</td><td>{kind}</td><td>{what}</td></tr>");
    }
    table + "</table>\n"
}

/// What a variable is; of a parameter, when it may be set.
fn kind(variable: &Variable) -> String {
    match variable.quantity.causality() {
        "parameter" => format!("{} parameter", variable.variability()),
        causality => causality.into(),
    }
}

/// Legible without any file beside it, and on a narrow screen, where long names break rather than the table scrolls.
const STYLE: &str = "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<style>
body { font-family: sans-serif; line-height: 1.4; max-width: 60em; margin: 1em auto; padding: 0 1em; color: #222; background: #fff }
table { border-collapse: collapse; display: block; overflow-x: auto; margin: 1em 0 }
th, td { border: 1px solid #bbb; padding: 0.2em 0.6em; text-align: left; vertical-align: top }
th { background: #eee }
@media (min-width: 40em) { td:nth-child(3) { white-space: nowrap } }
@media (max-width: 40em) { table { font-size: 0.8em }
th, td { padding: 0.1em 0.3em }
td:first-child { overflow-wrap: anywhere; min-width: 7em } }
</style>\n";

const MOUNTING: &str = "<h2>How to mount it</h2>\n<p>Forces, displacements, velocities and accelerations are positive along +z. A spring of \
     stiffness k and a damper c between the panel and a base that moves by u_b and v_b put the force k (u_b - u) + c (v_b - v) on the panel, \
     with u and v the displacement and velocity at the same place; the base gets the opposite. A master that hands motions and forces over \
     once a step h, the force held over it, is stable at steps up to half the least of sqrt(m/k), m/c and c/k, and up to half the period of the highest mode, with m the mass that the place \
     shows a sudden force, below: a held force lags by h/2 on the mean, which takes k h/2 from the damper. So at a step h the damper must be from 2 h k up, \
     and k and c at most what stands under h. Then the error falls with the \
     step; with forces predicted to the end of the next step, and force_linear, with its square. A blow of a hammer is no mount: any \
     step that follows the blow will do.</p>\n";
const INSIDE: &str = "<p>Mounts inside the FMU need none of this: the spring and the damper on the panel's side are part of its equations and are stepped \
     exactly with it, whatever their stiffness, damping and the step. Over a step the base goes on from base_displacement_ at base_velocity_, or with \
     force_linear both run linearly to the values set; base_force_ = k (u - u_b) + c (v - v_b) is what the base gets. What errs is how the base's motion \
     is handed over: the spring's share of the force by the square of the step, the damper's by the step, with force_linear both by its square. A base that is light beside m above is coupled to the mount as to any stiff element: give it its mass, or \
     iterate. mount_.._stiffness and mount_.._damping may be set while the simulation runs. The modes above are those of the panel without its \
     mounts.</p>\n";
const UNIFORM: &str = "<p>Pressure, a field of acceleration and a moving frame work on the modes that are kept, by the integrals over their shapes; residual modes \
     are left alone.</p>\n";
const FRAME: &str = "<p>The frame that holds the edges is moved by base_acceleration and its angular accelerations: displacements, velocities and accelerations are \
     absolute, with the frame's own motion as the first states, which start at rest. frame_force and its moments are what the frame feels: all loads less \
     the rate of the panel's momentum; at rest they are exact, above the modes kept the panel left out counts as moving with the frame.</p>\n";
const ROTATIONS: &str = "<p>A couple acts by two forces a thickness of the panel apart, as a bracket brings it in, and a rotation is the slope between the same \
     two places. Residual modes are those of forces: a couple's own static answer is held as far as the modes reach.</p>\n";
const DOUBT: &str = " Behind a frequency stands the standard deviation that those of the constants make of it, with the correlation that the model file tells.";
const REFERENCE: &str = "<h2>Does an importer run it right?</h2>\n<p><a href=\"Reference.csv\">Reference.csv</a> has a half-sine hit of 100 N on the \
     first force, of the panel as exported, in co-simulation by the steps in <a href=\"Reference.opt\">Reference.opt</a>. A row has the force that is \
     set at that time and held over the step that follows, and the outputs before it is set. A run by the same steps gives these numbers to \
     1e-9 of each output's peak; an importer that sets its inputs late, or reads outputs early, is a step beside them.</p>\n";
const LICENSES: &str = "Licences of the libraries in it: <a href=\"licenses/license.txt\">licenses/license.txt</a>.";
const PARAMETERS: &str = "All parameters may be set before or in initialization mode. The tunable ones, which are the damping \
     ratios and the places of forces and responses, may also be set while the simulation runs: in co-simulation between two steps, \
     in model exchange in event mode. The modes are those of the undamped panel, which neither damping nor a port changes, so their \
     coordinates and velocities go on as they are. Where damping is set, displacements and velocities run on and accelerations \
     jump; where a place is set, outputs are from then on those of the new place. Sizes, mass and constants are fixed once \
     initialization has ended: with others the modes would have other shapes, and their coordinates another meaning. Where a \
     parameter is set, the modes are found anew, which takes milliseconds for a beam or a plate, some hundredths of a second \
     beside a core; for damping ratios alone, of a panel without effects, some hundredths of a millisecond. The number of modes is \
     that of the export.";
const HELD: &str = "The force is held at the value set before the step, over the whole step.";
const BY_DERIVATIVES: &str = " If the importer gives the first derivative of a force \
     (fmi2SetRealInputDerivatives), the force of the next step runs at that rate from the value set.";
const LINEAR: &str = " If the parameter force_linear is true, the force of a step runs linearly from its value at the \
     end of the last step to the value now set: set the value of the step's end before the step; until it is done, \
     outputs are those of the old value. Each mode is then \
     advanced exactly, whatever the step.";
/// CVode on `fmpy-checks`' beam of six modes: the first number is held by `test_model_exchange.py`, the others stand in orthopanel-fmu's README.
const EXCHANGE: &str = "</p>\n<h2>Model exchange</h2>\n<p>Set the forces wherever derivatives are asked for, together with time and states, and begin anew \
     where a force or its rate jumps: so done, CVode at the tolerance of DefaultExperiment, 1e-6, follows a half sine of 2 ms, sampled each 20 us, on a beam of six modes \
     up to 4 kHz within 0.6 % of the peak of each acceleration, with residual modes. Some masters set inputs between the solver's steps alone (FMPy 0.3.32 and fmusim \
     0.0.39 do), so that it sees stairs: there the same pulse errs by a third of the peak, at the driving point by all of it, with outputs each 20 us, and by 2 and 7 % with outputs each \
     2 us, whatever the tolerance; velocities err by 2 and 0.2 %. There take short intervals, set residual_damping_ratio to 0.7 or leave residual modes out, \
     or take co-simulation with force_linear, whose steps are exact.";
const MODES: &str = "These are the modes as exported; where a parameter is set they are others. Rigid modes have the frequency 0. Outputs are sums \
     over the modes. A mode's number is that of its \
     modal_position; damping_ratio_1 is of the first flexible mode of the panel without its effects.";
const INITIAL_STATE: &str = " The panel starts at rest. Where modal_position_1, modal_velocity_1 and so on are set before or in \
     initialization mode, it starts bent or moving: a displacement is the sum of these positions, each times the shape of its \
     mode, which in initialization mode is the directional derivative of the displacement by the position. A reset brings it to \
     rest again.";

/// What the modes left out add to displacements, and up to where an acceleration can do without them: a row a pair of ports.
fn left_out(resource: &Resource, Origin { bands, .. }: &Origin<'_>) -> String {
    let mut text = String::from(LEFT_OUT);
    text += &match bands.frequency_change() {
        // A beam alone has exact modes.
        Some(change) if change < 1e-9 => String::new(),
        Some(change) => format!(
            " The modes kept are those of a basis for their number: on a larger one their frequencies differ by up to {change:.1e} of \
             themselves, which near a resonance changes the accelerance by as much over its damping ratio."
        ),
        None => BESIDE_CORE.into(),
    };
    text += LEFT_OUT_TABLE;
    for r in 0..resource.ports().responses.len() {
        for f in 0..resource.ports().forces.len() {
            let remainder = bands.at_rest(r, f);
            let Band { of_octave, of_each_line } = bands.within_one_percent(r, f);
            let up_to = |band: Option<f64>| band.map_or("nowhere".into(), |band| format!("up to {band:.0} Hz"));
            let (octave, line) = (up_to(of_octave), up_to(of_each_line));
            let (response, force) = (resource.names().response(r), resource.names().force(f));
            let added = format!("{remainder:.3e} m/N");
            let _ = writeln!(
                text,
                "<tr><td>displacement_{response} under force_{force}: {added}</td><td>over octaves {octave}, line by line {line}</td></tr>"
            );
        }
    }
    text + "</table>\n"
}

const RESIDUAL: &str = "two of each force, which hold what it bends beyond the modes kept, at rest and at three quarters of the last \
     frequency kept, with its inertia (Craig and Chang, AIAA J. 14 (1976) 1633). With them displacement, velocity and acceleration are \
     derivatives of each other, a force at rest has its whole answer, and no displacement depends on a force at once, so that a mount of \
     any stiffness is stable at a step small enough. Their shapes are those of the places that the forces have when initialization ends. \
     Their damping ratio is the parameter residual_damping_ratio, as exported that of the modes beyond those kept,";
const STIFF: &str = "In co-simulation all modes are advanced exactly at any step, these too. In model exchange the integrator has to follow \
     the highest of these frequencies: set residual_damping_ratio to 0.7, and what it follows dies out within a period, or export with \
     --residual none, and the modes kept are all there are; displacements then lack what the modes left out add at rest.";
const NO_RESIDUAL: &str = "<p>No residual modes stand for the modes left out: displacements, velocities and accelerations lack them all. \
     The table below says what that comes to.</p>\n";

const LEFT_OUT: &str = "<h2>What the modes left out do</h2>\n<p>At rest they add to displacements what stands on the left, times the \
     force: residual modes hold it. On the right stands up to where displacement, velocity and acceleration, which all err by the same \
     share, err by less than 1 %, beside up to three times as many modes and the static part of the rest: first of the root mean square \
     of the accelerance over the octave around, then of the accelerance at each line by itself. The second ends earlier, as a rule at an \
     antiresonance, where little is left of the whole. Both are of the panel as exported, before parameters are set.";
const BESIDE_CORE: &str = " At rest the core has its low modulus: where it has stiffened, the residual modes are too soft by its share \
     of that. Accelerances are by the core's own law here, without the \
     error of its fit, and what they lack holds how far the frequencies of these modes move on a larger basis.";
const LEFT_OUT_TABLE: &str =
    "</p>\n<table>\n<tr><th>static part of the modes left out</th><th>motion within 1 %</th></tr>\n";
