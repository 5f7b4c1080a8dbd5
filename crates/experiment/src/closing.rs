//! Loops that are closed: of one system, or of a plant and a controller.

use tracelight_chart::Colour;
use tracelight_linear::{
    Complex, Delayed, FeedbackLoop, FrequencyData, LinearError, LoopFunction, LoopMember, Time,
    TransferFunction,
};
use tracelight_task::Failure;

use crate::named::{Late, Named};

/// A plant and a controller in a loop.
pub(crate) struct Around {
    pub(crate) plant: Named,
    pub(crate) controller: Named,
    /// Their open loop, of positive feedback times −1.
    pub(crate) open: Named,
    /// The loop; none of what was measured.
    of: Option<FeedbackLoop>,
    positive: bool,
}

impl Around {
    /// A loop that is called by a name.
    ///
    /// # Errors
    /// `no-such-system` of parts that do not go together, a loop that answers without bounds, and two parts that were measured.
    pub(crate) fn new(
        plant: Named,
        controller: Named,
        name: String,
        positive: bool,
    ) -> Result<Self, Failure> {
        let failed = |e: LinearError| no_loop(&name, &e);
        let sign = if positive { -1.0 } else { 1.0 };
        let (of, open) = match (&plant.data, &controller.data) {
            (None, None) => {
                let of =
                    FeedbackLoop::new(plant.delayed(), controller.delayed(), positive).map_err(failed)?;
                let order = plant.late.as_ref().or(controller.late.as_ref()).map(|late| late.order);
                let open = late(name, of.open().clone(), order, plant.colour)?;
                (Some(of), open)
            }
            (Some(data), None) | (None, Some(data)) => {
                let other = if plant.data.is_some() { &controller } else { &plant };
                if other.system.time() != Time::Continuous {
                    let e =
                        LinearError::Sampling("what was measured".into(), other.system.time().to_string());
                    return Err(failed(e));
                }
                let data = data.times(|rad_s| sign * other.at(rad_s)).map_err(failed)?;
                (None, Named::measured(name, data, plant.colour))
            }
            (Some(_), Some(_)) => {
                let message = format!("{name}: one of plant and controller may be measured, not both");
                return Err(Failure::failed("no-such-system", message));
            }
        };
        let unstable = plant.unstable.or(controller.unstable);
        Ok(Self { open: Named { unstable, is_positive: positive, ..open }, plant, controller, of, positive })
    }

    /// One of its four transfer functions, called by a name.
    ///
    /// # Errors
    /// `no-such-system` of data that become none.
    pub(crate) fn member(&self, member: LoopMember, name: String) -> Result<Named, Failure> {
        let failed = |e: LinearError| no_loop(&name, &e);
        let colour = self.plant.colour;
        let named = match &self.of {
            None => Named::measured(name.clone(), self.measured(member).map_err(failed)?, colour),
            Some(of) => function(of.function(member), name.clone(), self.open.late.as_ref(), colour)?,
        };
        Ok(Named { opened: Some(Box::new(self.open.clone())), ..named })
    }

    /// The value of a member where the open loop and what stands before it are known.
    pub(crate) fn value(&self, member: LoopMember, rad_s: f64, open: Complex) -> Complex {
        let sign = if self.positive { -1.0 } else { 1.0 };
        let above = match member {
            LoopMember::Sensitivity => Complex::ONE,
            LoopMember::Complementary => sign * open,
            // the one that was measured is the open loop by the other
            LoopMember::Load if self.plant.data.is_some() => sign * open / self.controller.at(rad_s),
            LoopMember::Load => self.plant.at(rad_s),
            LoopMember::Control if self.controller.data.is_some() => sign * open / self.plant.at(rad_s),
            LoopMember::Control => self.controller.at(rad_s),
        };
        above / (1.0 + open)
    }

    fn measured(&self, member: LoopMember) -> Result<FrequencyData, LinearError> {
        let data = self.open.data.as_ref().ok_or(LinearError::NotFinite)?;
        data.mapped(|rad_s, open| self.value(member, rad_s, open))
    }

    /// One of its four transfer functions, of a loop that was not measured.
    pub(crate) fn function(&self, member: LoopMember) -> Option<LoopFunction> {
        Some(self.of.as_ref()?.function(member))
    }
}

fn no_loop(name: &str, error: &LinearError) -> Failure {
    Failure::failed("no-such-system", format!("{name}: {error}"))
}

/// A system, with a dead time if it has one, which is approximated in an order where only a rational one will do.
pub(crate) fn late(
    name: String,
    system: Delayed,
    order: Option<usize>,
    colour: Colour,
) -> Result<Named, Failure> {
    if system.delay_s() == 0.0 {
        return Ok(Named::rational(name, system.rational().clone(), colour));
    }
    let late = Late::of(system, order);
    let system = late.open.approximated(late.order).map_err(|e| no_loop(&name, &e))?;
    Ok(Named { late: Some(late), ..Named::rational(name, system, colour) })
}

/// A transfer function of a loop, whose open loop may have a dead time.
fn function(
    function: LoopFunction,
    name: String,
    open: Option<&Late>,
    colour: Colour,
) -> Result<Named, Failure> {
    if let Some(rational) = function.rational() {
        return Ok(Named::rational(name, rational.clone(), colour));
    }
    let (order, good_to) = open.map_or((1, (0.0, 0.0)), |late| (late.order, late.good_to));
    let system = function.approximated(order).map_err(|e| no_loop(&name, &e))?;
    let late = Late { open: function.open().clone(), closed: Some(function), order, good_to };
    Ok(Named { late: Some(late), ..Named::rational(name, system, colour) })
}

/// Closed by feedback of its output as it is.
pub(crate) fn closed(named: Named, positive: bool) -> Result<Named, Failure> {
    let name = format!("{}, closed{}", named.name, if positive { " by positive feedback" } else { "" });
    let one = TransferFunction::gain(1.0, named.system.time());
    let one = Named::rational("1".to_owned(), one, named.colour);
    let open = if positive { format!("−({})", named.name) } else { named.name.clone() };
    Around::new(named, one, open, positive)?.member(LoopMember::Complementary, name)
}

/// Times −1: the open loop that positive feedback is negative feedback of.
pub(crate) fn negated(named: Named) -> Result<Named, Failure> {
    let name = format!("−({})", named.name);
    match &named.data {
        Some(data) => {
            let data = data.scaled(-1.0).map_err(|e| no_loop(&name, &e))?;
            Ok(Named {
                unstable: named.unstable,
                is_positive: true,
                ..Named::measured(name, data, named.colour)
            })
        }
        None => {
            let order = named.late.as_ref().map(|late| late.order);
            let system = late(name, named.delayed().scaled(-1.0), order, named.colour)?;
            Ok(Named { is_positive: true, ..system })
        }
    }
}
