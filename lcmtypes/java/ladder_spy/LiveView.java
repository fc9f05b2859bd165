// SPDX-License-Identifier: BSD-3-Clause
package ladder_spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.awt.event.ActionEvent;
import java.util.function.Function;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JInternalFrame;
import javax.swing.JPanel;
import javax.swing.Timer;

import lcm.spy.ChannelData;

/** A panel that draws the newest message of one channel again and again while it is shown. */
abstract class LiveView extends JPanel {
    private final Timer timer;
    protected final ChannelData channel;

    LiveView(ChannelData channel, int periodMs, Dimension size) {
        this.channel = channel;
        timer = new Timer(periodMs, event -> refresh());
        setPreferredSize(size);
        setBackground(new Color(18, 18, 24));
    }

    /** Called once per period; a view that collects messages does it here. */
    protected void refresh() {
        repaint();
    }

    protected abstract void draw(Graphics2D graphics);

    @Override
    public void addNotify() {
        super.addNotify();
        timer.start();
    }

    @Override
    public void removeNotify() {
        timer.stop();
        super.removeNotify();
    }

    @Override
    protected void paintComponent(Graphics graphics) {
        super.paintComponent(graphics);
        final Graphics2D canvas = (Graphics2D) graphics.create();
        canvas.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
        draw(canvas);
        canvas.dispose();
    }

    /** A menu entry of the spy that opens the view in a window of its own. */
    static Action opener(String title, JDesktopPane desktop, ChannelData channel, Function<ChannelData, LiveView> make) {
        return new AbstractAction(title) {
            @Override
            public void actionPerformed(ActionEvent event) {
                final JInternalFrame window = new JInternalFrame(title + " " + channel.name, true, true);
                window.add(make.apply(channel));
                window.pack();
                window.setVisible(true);
                desktop.add(window);
            }
        };
    }
}
